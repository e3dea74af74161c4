#pragma once

#include <functional>

#include "base/error.h"

namespace shadowbench {

/// The Error that an action throws; one of kind kLimit, "no error", where it throws none.
inline Error error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return {ErrorKind::kLimit, "no error"};
}

}  // namespace shadowbench
