#include "harness/render/syntax_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace shadowbench::render {
namespace {

/// Tokens of Mesa's grammar that are not written as they are called.
constexpr std::array<std::pair<std::string_view, std::string_view>, 40> kTokens = {{
    {"NEW_IDENTIFIER", "a name"},
    {"IDENTIFIER", "a name"},
    {"ANY_IDENTIFIER", "a name"},
    {"any_identifier", "a name"},
    {"variable_identifier", "a name"},
    {"FIELD_SELECTION", "the name of a member"},
    {"TYPE_IDENTIFIER", "a type"},
    {"BASIC_TYPE_TOK", "a type"},
    {"INTCONSTANT", "a whole number"},
    {"UINTCONSTANT", "a whole number"},
    {"FLOATCONSTANT", "a number"},
    {"DOUBLECONSTANT", "a number"},
    {"BOOLCONSTANT", "'true' or 'false'"},
    {"ERROR_TOK", "a character that GLSL has not"},
    {"end of file", "the end of the text"},
    {"$end", "the end of the text"},
    {"END", "the end of the text"},
    {"EOL", "the end of the line"},
    {"LEFT_OP", "'<<'"},
    {"RIGHT_OP", "'>>'"},
    {"INC_OP", "'++'"},
    {"DEC_OP", "'--'"},
    {"LE_OP", "'<='"},
    {"GE_OP", "'>='"},
    {"EQ_OP", "'=='"},
    {"NE_OP", "'!='"},
    {"AND_OP", "'&&'"},
    {"OR_OP", "'||'"},
    {"XOR_OP", "'^^'"},
    {"MUL_ASSIGN", "'*='"},
    {"DIV_ASSIGN", "'/='"},
    {"MOD_ASSIGN", "'%='"},
    {"ADD_ASSIGN", "'+='"},
    {"SUB_ASSIGN", "'-='"},
    {"LEFT_ASSIGN", "'<<='"},
    {"RIGHT_ASSIGN", "'>>='"},
    {"AND_ASSIGN", "'&='"},
    {"XOR_ASSIGN", "'^='"},
    {"OR_ASSIGN", "'|='"},
    {"COLON", "':'"},
}};

constexpr std::string_view kNames[] = {"NEW_IDENTIFIER", "IDENTIFIER", "ANY_IDENTIFIER", "TYPE_IDENTIFIER",
                                       "FIELD_SELECTION"};

}  // namespace

bool is_name_token(std::string_view token) { return std::ranges::count(kNames, token) > 0; }

std::string name_token(const std::string& token) {
  if (token.starts_with('\'')) return token;
  const auto known = std::ranges::find(kTokens, token, &decltype(kTokens)::value_type::first);
  if (known != kTokens.end()) return std::string(known->second);
  std::string word = token.ends_with("_TOK") ? token.substr(0, token.size() - 4) : token;
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return "'" + word + "'";
}

SyntaxError read_syntax_error(const std::string& text) {
  constexpr std::string_view kBegin = "syntax error, unexpected ", kExpecting = ", expecting ", kOr = " or ";
  if (!text.starts_with(kBegin)) return {};
  const std::size_t end = std::min(text.find(kExpecting), text.size());
  SyntaxError read{text.substr(kBegin.size(), end - kBegin.size()), ""};
  for (std::size_t at = end + kExpecting.size(); at < text.size();) {
    const std::size_t next = std::min(text.find(kOr, at), text.size());
    const std::string word = name_token(text.substr(at, next - at));
    if (read.expected.find(word) == std::string::npos) read.expected += (read.expected.empty() ? "" : " or ") + word;
    at = next + kOr.size();
  }
  return read;
}

}  // namespace shadowbench::render
