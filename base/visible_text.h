#pragma once

#include <string>
#include <string_view>

namespace shadowbench {

/// Shows control characters of names and files as "\x1b", because they would steer the terminal. Newlines stay, for
/// the logs of shaders and for tables.
std::string make_visible(std::string_view text);

/// The same of a message, in which nothing is so long that the rest is lost from sight: names in it may have any
/// length. What is left out of the middle of a line, or of all lines, is counted.
std::string make_readable(std::string_view message);

}  // namespace shadowbench
