#include "filters/format/loops.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "filters/format/glsl_words.h"

namespace shadowbench::filters {
namespace {

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
