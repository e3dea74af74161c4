#include "harness/render/shader_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "filters/glsl_words.h"
#include "harness/gl/program.h"

namespace shadowbench::render {
namespace {

constexpr std::size_t kWidest = 100;  ///< bytes of a line that are quoted
constexpr std::size_t kFew = 3;       ///< a name is near another where one of so many letters differs at most

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_of_word(char c) { return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The word that begins there; empty where none does.
std::string word_at(const std::string& line, std::size_t at) {
  if (at >= line.size() || !is_letter(line[at]) || (at > 0 && is_of_word(line[at - 1]))) return {};
  return line.substr(at, std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(at), line.end(), is_of_word) -
                             line.begin() - static_cast<std::ptrdiff_t>(at));
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

/// The beginning of a line as it is quoted: of whole characters, without those that no line has.
std::string quote(const std::string& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  std::size_t end = std::min(begin + kWidest, line.size());
  while (end < line.size() && (static_cast<unsigned char>(line[end]) & 0xC0U) == 0x80U) ++end;
  std::string text = "\n    " + line.substr(begin, end - begin);
  std::replace_if(
      text.begin() + 1, text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text.substr(0, text.find_last_not_of(" \n") + 1);
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

  /// "what is meant\n    the line"
  std::string explain(const gl::Complaint& complaint) const {
    const std::string line = find_text(complaint.line);
    return (complaint.is_error ? "" : "warning: ") + find_meaning(complaint.text, line) + quote(line);
  }

 private:
  const gl::Piece& filter_;
  std::vector<std::string> known_;  ///< names that it may use

  std::string suggest(const std::string& name) const {
    return std::ranges::count(known_, name) > 0 ? "" : did_you_mean(name, known_, kFew);
  }

  std::string find_meaning(const std::string& text, const std::string& line) const {
    const auto says = [&](const char* words) { return text.find(words) != std::string::npos; };
    if (says("syntax error, unexpected") && says("IDENTIFIER")) return text + suggest_word(line);
    const std::string name = find_quoted_name(text);
    const bool is_known = says("overloaded") && std::ranges::count(known_, name) > 0;
    if (name.empty() || is_known || !says_unknown(text)) return text;
    const char* form = says("function") ? "there is no function '{}'{}"
                       : says("field")  ? "there is no member '{}'{}"
                                        : "'{}' is not declared{}";
    return fmt::format(fmt::runtime(form), name, suggest(name));
  }

  /// A misspelt type or statement makes the name behind it unexpected: "flaot x".
  std::string suggest_word(const std::string& line) const {
    for (std::size_t at = 0; at < line.find("//") && at < line.size(); ++at) {
      const std::string word = word_at(line, at), near = word.size() < kFew ? "" : suggest(word);
      if (!near.empty()) return fmt::format(": '{}' is not known{}", word, near);
    }
    return {};
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

/// Names a variant for people and drivers, who do not need the values.
std::string variant_name(const std::string& file, const Defines& defines) {
  std::string name = file;
  for (const auto& [key, value] : defines) name += " " + key;
  return name;
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

gl::ShaderSource ShaderLibrary::source(const std::string& file, const Defines& defines,
                                       const std::vector<gl::Piece>& pieces) const {
  gl::SourceOptions options;
  options.roots = {folder_};
  options.main_file = file;
  options.defines = defines;
  options.pieces = pieces;
  return gl::build_source(options);
}

gl::Program& ShaderLibrary::fullscreen(const std::string& fragment_file, const Defines& defines) {
  return keep(
      fragment_file, defines,
      [&] {
        return gl::Program(variant_name(fragment_file, defines), gl::FullscreenTriangle::vertex_source(),
                           source(fragment_file, defines, {}));
      });
}

gl::Program& ShaderLibrary::geometry(const std::string& shader, const Defines& defines) {
  return keep(
      shader, defines,
      [&] {
        const bool has_third = std::ranges::find(defines, kExactEdges) != defines.end();
        const auto third = has_third ? std::optional(source(shader + ".geom", defines, {})) : std::nullopt;
        return gl::Program(variant_name(shader, defines), source(shader + ".vert", defines, {}),
                           source(shader + ".frag", defines, {}), std::nullopt, third);
      });
}

gl::Program& ShaderLibrary::keep(const std::string& name, const Defines& defines,
                                 const std::function<gl::Program()>& compile) {
  std::string key = name;
  for (const auto& [define, value] : defines) key += fmt::format("\n{} {}", define, value);
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  ++compiled_;
  return programs_.emplace(key, compile()).first->second;
}

gl::Program ShaderLibrary::compile_filter(const std::string& label, const std::string& fragment_file,
                                          const Defines& defines, const std::vector<gl::Piece>& pieces) {
  ++compiled_;
  const gl::ShaderSource fragment = source(fragment_file, defines, pieces);
  try {
    return gl::Program(label, gl::FullscreenTriangle::vertex_source(), fragment, ErrorKind::kFilter);
  } catch (const gl::CompileError& error) {
    throw explain_mistakes(error, pieces, fragment);
  }
}

}  // namespace shadowbench::render
