#pragma once

#include <string>
#include <string_view>

namespace shadowbench::filters {

// Just enough of GLSL to know what a filter's text has. Regular expressions of the standard library are not used: they
// recurse, and a long file of a user would end the program.

/// The text with every comment turned into a blank.
std::string strip_comments(const std::string& glsl);

/// The text with every run of blanks between other characters as one: a line's end where it holds one, or a space.
std::string squeeze_blanks(std::string_view text);

/// Whether the word stands by itself somewhere in the code.
bool has_word(std::string_view code, std::string_view word);

/// Whether the code declares `type name(`.
bool has_function(std::string_view code, std::string_view type, std::string_view name);

/// Whether GLSL takes this for a name of one's own.
bool is_identifier(const std::string& name);

/// A filter's GLSL in which loops count.
struct CountedLoops {
  std::string body;  ///< with as many lines as before
  int loops = 0;
};

/// Wraps the condition of every `for` and `while` as `count_turn(INDEX, condition)`, of lib/map_access.glsl. A
/// condition that declares something is left as it is, and so is what does not look like a loop.
CountedLoops count_loops(const std::string& glsl);

}  // namespace shadowbench::filters
