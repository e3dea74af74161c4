#pragma once

#include <gtest/gtest.h>

#include "base/error.h"

namespace shadowbench {

/// Runs `action` and returns the Error that it throws; fails the test when it throws none.
template <typename Action>
Error catch_error(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no Error was thrown";
  return Error(ErrorKind::kLimit, "");
}

}  // namespace shadowbench
