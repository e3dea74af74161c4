#include "harness/render/filter_mistakes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>
#include <vector>

#include "base/nearest_name.h"
#include "filters/format/glsl_words.h"
#include "harness/render/syntax_words.h"

namespace shadowbench::render {
namespace {

constexpr std::size_t kWidest = 100;  ///< bytes of a line that are quoted
constexpr std::size_t kFew = 3;       ///< a name is near another where one of so many letters differs at most

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_of_word(char c) { return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The word that begins there; empty where none does.
std::string word_at(const std::string& line, std::size_t at) {
  if (at >= line.size() || !is_letter(line[at]) || (at > 0 && is_of_word(line[at - 1]))) return {};
  std::size_t end = at;
  while (end < line.size() && is_of_word(line[end])) ++end;
  return line.substr(at, end - at);
}

/// Where the word before a place begins, with nothing but blanks between.
std::optional<std::size_t> find_word_before(const std::string& line, std::size_t at) {
  std::size_t end = at;
  while (end > 0 && is_blank(line[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && is_of_word(line[begin - 1])) --begin;
  return begin < end && end < at && is_letter(line[begin]) ? std::optional(begin) : std::nullopt;
}

/// Undoes what Mesa's preprocessor makes of a line: the place of the column there. Nothing where no word, number or
/// sign begins there, which is so behind macros that were replaced.
std::optional<std::size_t> find_column(const std::string& line, int column) {
  int passed = 0;
  bool was_blank = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const std::size_t comment = line.compare(at, 2, "/*") == 0 ? line.find("*/", at + 2) : std::string::npos;
    const bool blank = is_blank(line[at]) || comment != std::string::npos;
    if (comment != std::string::npos) at = comment + 1;
    passed += blank && was_blank ? 0 : 1;
    was_blank = blank;
    if (passed < column) continue;
    return blank || (at > 0 && is_of_word(line[at]) && is_of_word(line[at - 1])) ? std::nullopt : std::optional(at);
  }
  return std::nullopt;
}

/// The place nearest to another one at which a text stands, as a whole word where it is one.
std::optional<std::size_t> find_nearest(const std::string& line, const std::string& text, std::size_t wanted) {
  std::optional<std::size_t> nearest;
  const auto distance = [&](std::size_t at) { return at > wanted ? at - wanted : wanted - at; };
  for (std::size_t at = line.find(text); at != std::string::npos; at = line.find(text, at + 1)) {
    if (is_letter(text.front()) && word_at(line, at) != text) continue;
    if (!nearest || distance(at) < distance(*nearest)) nearest = at;
  }
  return nearest;
}

/// The first name in quotes: "x" of "no function with name 'x'" and of "`x' undeclared".
std::string find_quoted_name(const std::string& text) {
  const std::size_t quote = text.find_first_of("`'\"");
  return quote == std::string::npos ? "" : word_at(text, quote + 1);
}

bool says_unknown(const std::string& text) {
  constexpr std::string_view kSigns[] = {"no function with name",           "undeclared",          "undefined variable",
                                         "no matching overloaded function", "cannot access field", "no such field"};
  return std::ranges::any_of(kSigns, [&](std::string_view sign) { return text.find(sign) != std::string::npos; });
}

/// Whether a compiler may say this because of an error before it.
bool may_follow(const gl::Complaint& complaint) {
  constexpr std::string_view kBeginnings[] = {"type mismatch", "operands to ", "could not implicitly convert",
                                              "syntax error, unexpected ERROR_TOK"};
  return !complaint.is_error || std::ranges::any_of(kBeginnings, [&](std::string_view beginning) {
    return complaint.text.starts_with(beginning);
  });
}

/// A line as it is quoted, with a caret below a place.
std::string quote(const std::string& line, const std::optional<std::size_t>& caret) {
  const std::size_t indent = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t begin = caret && *caret > indent + kWidest ? *caret - kWidest / 2 : indent;
  const auto is_inside_character = [&](std::size_t at) {
    return at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0U) == 0x80U;
  };
  std::size_t first = begin, last = std::min(begin + kWidest, line.size());
  while (is_inside_character(first)) ++first;
  while (is_inside_character(last)) ++last;
  std::string text = "    ", below = text;
  for (std::size_t at = first; at < last; ++at) {
    const auto code = static_cast<unsigned char>(line[at]);
    text += code < 0x20 || code == 0x7f ? ' ' : line[at];
    if (caret && at < *caret && !is_inside_character(at)) below += ' ';
  }
  while (text.ends_with(' ')) text.pop_back();
  return "\n" + text + (caret ? "\n" + below + "^" : "");
}

/// What a filter's own part of a shader declares: its parameters, its text, and what that includes.
std::vector<std::string> list_own_names(const gl::ShaderSource& shader, const gl::Piece& parameters) {
  const auto file = std::ranges::find(shader.files, parameters.display_name) - shader.files.begin();
  const std::size_t begin =
      std::min(shader.text.find(fmt::format("#line {} {}\n", gl::kLinesPerFile * file + parameters.first_line, file)),
               shader.text.size());
  const std::size_t end = shader.text.rfind("#line ");  // where the program's own text goes on
  return filters::list_declared_names(shader.text.substr(begin, std::max(begin, end) - begin));
}

/// Members of all structures, such as those of a receiver.
std::vector<std::string> list_members(const std::string& glsl) {
  std::vector<std::string> members;
  for (std::size_t at = glsl.find("\nstruct "); at != std::string::npos; at = glsl.find("\nstruct ", at + 1)) {
    const std::string body = glsl.substr(at, glsl.find('}', at) - at);
    std::ranges::move(filters::list_declared_names(body), std::back_inserter(members));
  }
  return members;
}

/// What is said of one complaint.
struct Explained {
  std::string text;
  std::optional<std::size_t> caret;
  bool lacks_other = false;  ///< something else is expected at the place
};

class Explainer {
 public:
  Explainer(const std::vector<gl::Piece>& pieces, const gl::ShaderSource& shader)
      : filter_(pieces.back()), known_(filters::list_map_names()) {
    for (std::vector<std::string>& more :
         std::vector{filters::list_language_words(), list_own_names(shader, pieces.front()), list_members(shader.text)})
      std::ranges::move(more, std::back_inserter(known_));
  }

  /// A line of the filter's file; empty where there is none of that number.
  std::string find_text(int line) const {
    std::size_t begin = line < filter_.first_line ? std::string::npos : 0;
    for (int number = filter_.first_line; number < line && begin != std::string::npos; ++number) {
      begin = filter_.text.find('\n', begin);
      if (begin != std::string::npos) ++begin;
    }
    return begin >= filter_.text.size() ? "" : filter_.text.substr(begin, filter_.text.find('\n', begin) - begin);
  }

  /// "what is meant\n    the line\n    ^"
  std::string explain(const gl::Complaint& complaint) const {
    const std::string line = find_text(complaint.line);
    const auto column = complaint.column > 0 ? find_column(line, complaint.column) : std::nullopt;
    const SyntaxError syntax = read_syntax_error(complaint.text);
    Explained explained =
        syntax.unexpected.empty() ? explain_meaning(complaint, line, column) : explain_syntax(syntax, line, column);
    const bool is_first = explained.caret == line.find_first_not_of(" \t");
    if (explained.lacks_other && is_first && syntax.expected.find("';'") != std::string::npos)
      explained.text += suggest_semicolon(complaint.line);
    const char* kind = complaint.is_error ? "" : "warning: ";
    return kind + explained.text + (line.empty() ? "" : quote(line, explained.caret));
  }

 private:
  const gl::Piece& filter_;
  std::vector<std::string> known_;  ///< names that it may use

  std::string suggest(const std::string& name) const {
    return std::ranges::count(known_, name) > 0 ? "" : did_you_mean(name, known_, kFew);
  }

  Explained explain_meaning(const gl::Complaint& complaint, const std::string& line,
                            const std::optional<std::size_t>& column) const {
    const std::string name = find_quoted_name(complaint.text);
    const auto named = name.empty() ? std::nullopt : find_nearest(line, name, column.value_or(0));
    const auto caret = named ? named : column;
    if (name.empty() || !says_unknown(complaint.text)) {
      std::string text = complaint.text;
      std::ranges::replace(text, '`', '\'');
      return {text, caret};
    }
    const auto says = [&](const char* words) { return complaint.text.find(words) != std::string::npos; };
    const char* form = says("function") ? "there is no function '{}'{}"
                       : says("field")  ? "there is no member '{}'{}"
                                        : "'{}' is not declared{}";
    const bool is_known = says("overloaded") && std::ranges::count(known_, name) > 0;
    return {is_known ? complaint.text : fmt::format(fmt::runtime(form), name, suggest(name)), caret};
  }

  /// A misspelt type or statement shows at the name behind it: "flaot x" at x.
  Explained explain_syntax(const SyntaxError& syntax, const std::string& line,
                           const std::optional<std::size_t>& column) const {
    std::optional<std::size_t> caret = column;
    std::string found = name_token(syntax.unexpected);
    if (is_name_token(syntax.unexpected)) {
      const std::string word = caret ? word_at(line, *caret) : "";
      if (!word.empty()) found = "'" + word + "'";
      if (const auto before = word.empty() ? std::nullopt : find_word_before(line, *caret)) {
        const std::string name = word_at(line, *before), near = suggest(name);
        if (!near.empty()) return {fmt::format("syntax error: '{}' is not known{}", name, near), before};
      }
    } else if (found.starts_with('\'') && found.size() > 2) {
      caret = find_nearest(line, found.substr(1, found.size() - 2), column.value_or(0));
    }
    if (syntax.expected.empty()) return {fmt::format("syntax error: {} cannot stand here", found), caret};
    return {fmt::format("syntax error: {} stands where {} is expected", found, syntax.expected), caret, true};
  }

  /// What begins a line may stand there wrongly because the line before it is not ended.
  std::string suggest_semicolon(int line) const {
    while (--line >= filter_.first_line)
      if (find_text(line).find_first_not_of(" \t\r") != std::string::npos)
        return fmt::format("; is a ';' missing at the end of line {}?", line);
    return "";
  }
};

/// What is to be told: no warnings behind an error, nor what follows from an error in the same line. What goes on from
/// the line before, as the candidates for a call do, is put there.
std::vector<gl::Complaint> choose_complaints(const std::vector<gl::Complaint>& all) {
  std::vector<gl::Complaint> chosen;
  bool has_error = false;
  for (const gl::Complaint& each : all) {
    if (each.text.starts_with("  ") && !chosen.empty()) {
      chosen.back().text += "\n      " + each.text.substr(each.text.find_first_not_of(' '));
      continue;
    }
    const bool is_same_line = !chosen.empty() && chosen.back().where() == each.where();
    if (has_error && may_follow(each) && (is_same_line || !each.is_error)) continue;
    has_error = has_error || each.is_error;
    chosen.push_back(each);
  }
  return chosen;
}

/// The line of a filter that first has a word; its last one where none has.
std::ptrdiff_t find_line(const gl::Piece& filter, std::string_view word) {
  const auto end =
      filter.text.begin() + static_cast<std::ptrdiff_t>(std::min(filter.text.find(word), filter.text.size()));
  return filter.first_line + std::count(filter.text.begin(), end, '\n');
}

/// Drivers say which function calls itself, as in "function `float f(int)' has static recursion", but not where.
Error blame_recursion(const std::string& message, const gl::Piece& filter) {
  const std::size_t parenthesis = message.find('(', message.find('`'));
  const std::size_t blank = message.rfind(' ', parenthesis);
  const bool is_named = parenthesis != std::string::npos && blank != std::string::npos;
  const std::string name = is_named ? message.substr(blank + 1, parenthesis - blank - 1) : std::string();
  return Error(ErrorKind::kFilter,
               fmt::format("{} calls itself, directly or through others, and GLSL has no recursion: write a loop",
                           is_named ? "'" + name + "'" : "a function"),
               fmt::format("{}:{}", filter.display_name, find_line(filter, name)));
}

/// The compiler notices a missing brace only in the code after the filter's; the message names the end of the filter
/// instead.
Error blame_end(const Error& error, const gl::Piece& filter) {
  const auto lines = std::count(filter.text.begin(), filter.text.end(), '\n');
  return Error(
      ErrorKind::kFilter,
      fmt::format("the GLSL breaks the code after it, at or before this line (a missing brace, or a name that the "
                  "program uses itself?): {}",
                  error.message()),
      fmt::format("{}:{}", filter.display_name, filter.first_line + static_cast<int>(lines) - 1));
}

}  // namespace

Error explain_mistakes(const gl::CompileError& error, const std::vector<gl::Piece>& pieces,
                       const gl::ShaderSource& shader) {
  const gl::Piece& filter = pieces.back();
  const auto is_own = [&](const gl::Complaint& each) { return each.is_error && each.file == filter.display_name; };
  const auto first = std::ranges::find_if(error.complaints(), is_own);
  if (first == error.complaints().end()) {
    if (error.where().starts_with(filter.display_name)) return error;  // what the program declares of its parameters
    return error.message().find("recursion") != std::string::npos ? blame_recursion(error.message(), filter)
                                                                  : blame_end(error, filter);
  }
  const std::string heading = error.message().substr(0, error.message().find(": ") + 2);
  const Explainer explainer(pieces, shader);
  std::string text, where;
  for (const gl::Complaint& each : choose_complaints(error.complaints())) {
    const bool is_of_file = each.file == filter.display_name;
    const std::string words = is_of_file ? explainer.explain(each) : each.text;
    text +=
        where.empty() ? heading + words : fmt::format("\n{}{}{}", each.where(), each.file.empty() ? "" : ": ", words);
    if (where.empty()) where = each.where();
  }
  return {ErrorKind::kFilter, text, where};
}

}  // namespace shadowbench::render
