#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::filters {

// Just enough of GLSL to know what a filter's text has. Regular expressions of the standard library are not used: they
// recurse, and a long file of a user would end the program.

/// The text with every comment turned into as many blanks as it has characters, and its line ends.
std::string blank_comments(std::string glsl);

/// The text with every run of blanks between other characters as one: a line's end where it holds one, or a space.
std::string squeeze_blanks(std::string_view text);

/// Whether the word stands by itself somewhere in the code.
bool has_word(std::string_view code, std::string_view word);

/// Whether the code declares `type name(`.
bool has_function(std::string_view code, std::string_view type, std::string_view name);

/// Whether GLSL takes this for a name of one's own.
bool is_identifier(const std::string& name);

/// Words of the language itself that a filter may write: types, statements, and functions.
std::vector<std::string> list_language_words();

/// Functions and variables that every filter may use; shaders/lib has them, and filters/README.md tells of them.
std::vector<std::string> list_map_names();

/// Names that the code declares behind a type: functions, variables, parameters, members, constants; structures; and
/// macros, but for those in capitals alone. Of "float a, b;" the first alone. Some are listed twice.
std::vector<std::string> list_declared_names(const std::string& glsl);

/// A filter's GLSL in which loops count.
struct CountedLoops {
  std::string body;  ///< with as many lines as before
  int loops = 0;
};

/// Wraps the condition of every `for` and `while` as `count_turn(INDEX, condition)`, of lib/map_access.glsl. A
/// condition that declares something is left as it is, and so is what does not look like a loop.
CountedLoops count_loops(const std::string& glsl);

}  // namespace shadowbench::filters
