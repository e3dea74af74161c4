#pragma once

#include <string>
#include <string_view>

namespace shadowbench::render {

/// What a compiler's syntax error says: "syntax error, unexpected RETURN, expecting ',' or ';'".
struct SyntaxError {
  std::string unexpected;  ///< the token as the compiler calls it; empty: the text is no such sentence
  std::string expected;    ///< in words, "',' or ';'"; empty where the compiler names nothing
};

/// Reads the sentence that Mesa's parser makes.
SyntaxError read_syntax_error(const std::string& text);

/// Whether a token is a name, and its text therefore not known from its kind.
bool is_name_token(std::string_view token);

/// A token in words or as it is written: "a name" for NEW_IDENTIFIER, "'return'" for RETURN, "'<='" for LE_OP.
std::string name_token(const std::string& token);

}  // namespace shadowbench::render
