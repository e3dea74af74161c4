#include "filters/glsl_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace shadowbench::filters {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";

constexpr std::string_view kTypes =
    "void bool int uint float vec2 vec3 vec4 ivec2 ivec3 ivec4 uvec2 uvec3 uvec4 bvec2 bvec3 bvec4 mat2 mat3 mat4 "
    "sampler2D usampler2D sampler2DShadow struct";
constexpr std::string_view kOtherWords =
    "if else for while do return break continue switch case default discard const in out inout true false radians "
    "degrees sin cos tan asin acos atan sinh cosh tanh pow exp log exp2 log2 sqrt inversesqrt abs sign floor trunc "
    "round roundEven ceil fract mod modf min max clamp mix step smoothstep isnan isinf fma length distance dot cross "
    "normalize faceforward reflect refract transpose determinant inverse lessThan lessThanEqual greaterThan "
    "greaterThanEqual equal notEqual any all not texture textureLod textureGrad textureSize textureGather texelFetch "
    "dFdx dFdy fwidth bitCount findLSB findMSB floatBitsToInt floatBitsToUint intBitsToFloat uintBitsToFloat";

constexpr std::string_view kMapNames =
    "compare_nearest compare_2x2 fetch_depth gather_compare gather_depth nearest_depth corner_depth fetch_map "
    "load_depth "
    "load_map texel_fraction texels_per_pixel random_turn interleaved_gradient_turn blue_noise_turn map_depth "
    "map_compare map_compare_nearest map_stored map_texel_uv load_screen screen_value";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_word_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

/// Where the comment that begins at `start` ends: at its line's break, or after its closing mark, or with the code.
/// `start` itself where no comment begins there.
std::size_t end_of_comment(const std::string& glsl, std::size_t start) {
  const bool line = glsl.compare(start, 2, "//") == 0;
  if (!line && glsl.compare(start, 2, "/*") != 0) return start;
  const std::size_t close = line ? glsl.find('\n', start) : glsl.find("*/", start + 2);
  if (close == std::string::npos) return glsl.size();
  return line ? close : close + 2;
}

/// Where the word stands by itself next, from `start` on; npos where it does not.
std::size_t find_word(std::string_view code, std::string_view word, std::size_t start) {
  for (std::size_t at = code.find(word, start); at != std::string_view::npos; at = code.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_word_character(code[at - 1]);
    if (begins && (end == code.size() || !is_word_character(code[end]))) return at;
  }
  return std::string_view::npos;
}

/// Words, and what else is no blank, character by character.
std::vector<std::string> split_tokens(std::string_view code) {
  std::vector<std::string> tokens;
  for (std::size_t at = code.find_first_not_of(kBlank); at < code.size();) {
    std::size_t end = at + 1;
    while (is_word_character(code[at]) && end < code.size() && is_word_character(code[end])) ++end;
    tokens.emplace_back(code.substr(at, end - at));
    at = code.find_first_not_of(kBlank, end);
  }
  return tokens;
}

/// Where a loop's condition is; empty where there is none to be found.
struct Condition {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The parenthesis that closes the one at `open`, and the semicolons directly inside.
struct Parentheses {
  std::size_t close = std::string::npos;
  std::vector<std::size_t> semicolons;
};

Parentheses match(const std::string& code, std::size_t open) {
  Parentheses found;
  int depth = 0;
  for (std::size_t i = open; i < code.size(); ++i) {
    if (code[i] == '(') ++depth;
    if (code[i] == ';' && depth == 1) found.semicolons.push_back(i);
    if (code[i] != ')' || --depth > 0) continue;
    found.close = i;
    return found;
  }
  return found;
}

/// Whether it holds a single `=`, which no comparison is.
bool declares(std::string_view condition) {
  for (std::size_t i = 0; i < condition.size(); ++i) {
    if (condition[i] != '=') continue;
    if (i + 1 < condition.size() && condition[i + 1] == '=') {
      ++i;
      continue;
    }
    if (i == 0 || std::string_view("<>!").find(condition[i - 1]) == std::string_view::npos) return true;
  }
  return false;
}

Condition find_condition(const std::string& code, std::size_t after_word, bool is_for) {
  const std::size_t open = code.find_first_not_of(" \t\r\n", after_word);
  if (open == std::string::npos || code[open] != '(') return {};
  const Parentheses inner = match(code, open);
  if (inner.close == std::string::npos) return {};
  if (!is_for) return {open + 1, inner.close};
  if (inner.semicolons.size() != 2) return {};
  return {inner.semicolons[0] + 1, inner.semicolons[1]};
}

}  // namespace

std::string blank_comments(std::string glsl) {
  for (std::size_t i = 0; i < glsl.size(); ++i) {
    const std::size_t end = end_of_comment(glsl, i);
    for (std::size_t at = i; at < end; ++at)
      if (glsl[at] != '\n') glsl[at] = ' ';
  }
  return glsl;
}

std::string squeeze_blanks(std::string_view text) {
  std::string squeezed;
  for (std::size_t at = text.find_first_not_of(kBlank); at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kBlank, at), text.size());
    squeezed += text.substr(at, end - at);
    at = text.find_first_not_of(kBlank, end);
    if (at < text.size()) squeezed += text.substr(end, at - end).find('\n') == std::string_view::npos ? ' ' : '\n';
  }
  return squeezed;
}

bool has_word(std::string_view code, std::string_view word) {
  return find_word(code, word, 0) != std::string_view::npos;
}

bool has_function(std::string_view code, std::string_view type, std::string_view name) {
  for (std::size_t at = find_word(code, name, 0); at != std::string_view::npos; at = find_word(code, name, at + 1)) {
    const std::size_t after = code.find_first_not_of(kBlank, at + name.size());
    const std::size_t before = at == 0 ? std::string_view::npos : code.find_last_not_of(kBlank, at - 1);
    if (after == std::string_view::npos || code[after] != '(' || before == std::string_view::npos) continue;
    const std::string_view left = code.substr(0, before + 1);
    const bool is_whole = left.size() == type.size() ||
                          (left.size() > type.size() && !is_word_character(left[left.size() - type.size() - 1]));
    if (left.ends_with(type) && is_whole) return true;
  }
  return false;
}

std::vector<std::string> list_language_words() {
  std::vector<std::string> words = split_tokens(kTypes);
  std::ranges::move(split_tokens(kOtherWords), std::back_inserter(words));
  return words;
}

std::vector<std::string> list_map_names() { return split_tokens(kMapNames); }

std::vector<std::string> list_declared_names(const std::string& glsl) {
  const std::vector<std::string> tokens = split_tokens(blank_comments(glsl));
  std::vector<std::string> types = split_tokens(kTypes), names;
  const auto is_capital = [](char c) { return (c >= 'A' && c <= 'Z') || c == '_'; };
  for (std::size_t i = 1; i < tokens.size(); ++i) {
    const std::string &before = tokens[i - 1], &token = tokens[i];
    if (!is_letter(token.front())) continue;
    if (before == "struct") types.push_back(token);
    const bool is_macro = before == "define" && !std::ranges::all_of(token, is_capital);
    if (is_macro || std::ranges::count(types, before) > 0) names.push_back(token);
  }
  return names;
}

bool is_identifier(const std::string& name) {
  return !name.empty() && is_letter(name.front()) && std::ranges::all_of(name, is_word_character) &&
         !name.starts_with("gl_") && name.find("__") == std::string::npos;
}

CountedLoops count_loops(const std::string& glsl) {
  const std::string code = blank_comments(glsl);
  CountedLoops counted;
  std::size_t copied = 0;
  for (std::size_t at = 0; at < code.size();) {
    const std::size_t next_for = find_word(code, "for", at), next_while = find_word(code, "while", at);
    const std::size_t word = std::min(next_for, next_while);
    if (word == std::string::npos) break;
    const bool is_for = word == next_for;
    at = word + (is_for ? 3 : 5);
    const Condition condition = find_condition(code, at, is_for);
    const std::string text = code.substr(condition.begin, condition.end - condition.begin);
    const bool is_empty = text.find_first_not_of(" \t\r\n") == std::string::npos;
    if (condition.end == 0 || declares(text) || (is_empty && !is_for)) continue;
    counted.body += glsl.substr(copied, condition.begin - copied);
    counted.body += fmt::format(" count_turn({}, {})", counted.loops++, is_empty ? "true" : text);
    copied = at = condition.end;
  }
  counted.body += glsl.substr(copied);
  return counted;
}

}  // namespace shadowbench::filters
