#pragma once

#include <string>
#include <string_view>

namespace shadowbench::filters {

// Just enough of GLSL to know what a filter's text has. Regular expressions of the standard library are not used: they
// recurse, and a long file of a user would end the program.

/// The text with every comment turned into a blank.
std::string strip_comments(const std::string& glsl);

/// The same with as many blanks as the comment has characters, and its line ends.
std::string blank_comments(const std::string& glsl);

/// Where the word stands by itself next, from `start` on; npos where it does not.
std::size_t find_word(std::string_view code, std::string_view word, std::size_t start);

/// The text with every run of blanks between other characters as one: a line's end where it holds one, or a space.
std::string squeeze_blanks(std::string_view text);

/// Whether the word stands by itself somewhere in the code.
bool has_word(std::string_view code, std::string_view word);

/// Whether the code declares `type name(`.
bool has_function(std::string_view code, std::string_view type, std::string_view name);

/// Whether GLSL takes this for a name of one's own.
bool is_identifier(const std::string& name);

}  // namespace shadowbench::filters
