#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "base/text.h"

namespace shadowbench::cli {

/// Prints text for people on standard output, with names as make_visible() shows them. JSON is printed as it is.
template <class... Values>
void print(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print("{}", make_visible(fmt::format(format, std::forward<Values>(values)...)));
}

/// Prints a message for people on standard error.
template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print(stderr, "{}", make_readable(fmt::format(format, std::forward<Values>(values)...)));
}

}  // namespace shadowbench::cli
