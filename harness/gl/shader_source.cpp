#include "harness/gl/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "base/error.h"

namespace shadowbench::gl {
namespace {

/// One text to insert, found among the pieces or the files.
struct Found {
  std::string key;  ///< one per text, whichever name reached it
  std::string text;
  std::string display_name;
  int first_line = 1;
  ErrorKind blame = ErrorKind::kInput;
};

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Walks over one line and says whether a block comment that may have been open before is open at its end.
bool is_comment_open_after(std::string_view line, bool open) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const std::string_view pair = line.substr(i, 2);
    if (!open && pair == "//") return false;
    if (pair != (open ? "*/" : "/*")) continue;
    open = !open;
    ++i;
  }
  return open;
}

/// Returns what follows `#name` on a line that is that directive.
std::optional<std::string_view> match_directive(std::string_view line, std::string_view name) {
  line = trim(line);
  if (!line.starts_with('#')) return std::nullopt;
  line = trim(line.substr(1));
  if (!line.starts_with(name)) return std::nullopt;
  const std::string_view rest = line.substr(name.size());
  if (!rest.empty() && (rest.front() == '_' || std::isalnum(static_cast<unsigned char>(rest.front())) != 0))
    return std::nullopt;
  return trim(rest);
}

std::optional<std::string> parse_include_name(std::string_view rest) {
  const std::size_t end = rest.size() < 3 || rest.front() != '"' ? std::string_view::npos : rest.find('"', 1);
  if (end == std::string_view::npos || end == 1) return std::nullopt;
  const std::string_view after = trim(rest.substr(end + 1));
  if (!after.empty() && !after.starts_with("//") && !after.starts_with("/*")) return std::nullopt;
  return std::string(rest.substr(1, end - 1));
}

/// Whether a name leaves the folders that it is looked up in: "../x", "/etc/passwd". What is read shows in messages.
bool leaves_folders(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
  return path.is_absolute() || path.empty() || *path.begin() == "..";
}

std::optional<std::string> read_text(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

class Builder {
 public:
  explicit Builder(const SourceOptions& options) : options_(options) {}

  ShaderSource build() {
    source_.files = {"(set by the program)"};
    source_.text = "#version 450 core\n";
    for (const auto& [name, value] : options_.defines) source_.text += fmt::format("#define {} {}\n", name, value);
    auto found = find(options_.main_file);
    if (!found) throw Error(ErrorKind::kInput, describe_missing(options_.main_file));
    append(*found);
    return std::move(source_);
  }

 private:
  std::optional<Found> find(const std::string& name) const {
    const auto piece = std::ranges::find(options_.pieces, name, &Piece::include_name);
    if (piece != options_.pieces.end())
      return Found{"piece:" + name, piece->text, piece->display_name, piece->first_line, ErrorKind::kFilter};
    for (const auto& root : options_.roots) {
      const auto path = (root / name).lexically_normal();
      if (auto text = read_text(path))
        return Found{path.generic_string(), std::move(*text), path.generic_string(), 1, ErrorKind::kInput};
    }
    return std::nullopt;
  }

  std::string describe_missing(const std::string& name) const {
    std::string roots;
    for (const auto& root : options_.roots) roots += fmt::format("{}{}", roots.empty() ? "" : ", ", root.string());
    return fmt::format("shader file '{}' not found; looked in {}", name, roots.empty() ? "no folder" : roots);
  }

  void append(const Found& found) {
    if (found.first_line + std::ranges::count(found.text, '\n') >= kLinesPerFile)
      throw Error(found.blame, fmt::format("has more than {} lines", kLinesPerFile - 1), found.display_name);
    if (const std::size_t nul = found.text.find('\0'); nul != std::string::npos) {
      const auto lines = std::count(found.text.begin(), found.text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
      throw Error(found.blame, "a NUL byte: this is no text, or was damaged; take the byte out",
                  fmt::format("{}:{}", found.display_name, found.first_line + lines));
    }
    open_.push_back(found.key);
    const auto index = source_.files.size();
    source_.files.push_back(found.display_name);
    std::string_view rest = found.text;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    append_line_directive(found.first_line, index);
    bool in_comment = false;
    int comment_line = 0;
    for (int number = found.first_line; !rest.empty(); ++number) {
      const std::size_t end = rest.find('\n');
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (in_comment || !append_include(line, found, number, index)) source_.text.append(line).push_back('\n');
      const bool open_after = is_comment_open_after(line, in_comment);
      if (open_after && !in_comment) comment_line = number;
      in_comment = open_after;
    }
    if (in_comment)
      throw Error(found.blame, "a comment is not closed", fmt::format("{}:{}", found.display_name, comment_line));
    open_.pop_back();
  }

  // Returns whether the line was an include and has been replaced.
  bool append_include(std::string_view line, const Found& from, int number, std::size_t index) {
    const std::string where = fmt::format("{}:{}", from.display_name, number);
    if (match_directive(line, "version"))
      throw Error(from.blame, "#version is set by the program (450 core); take this line out", where);
    if (match_directive(line, "line")) {
      throw Error(from.blame, "#line is set by the program, so that messages name your file; take this line out",
                  where);
    }
    const auto rest = match_directive(line, "include");
    if (!rest) return false;
    const auto name = parse_include_name(*rest);
    if (!name) throw Error(from.blame, "malformed #include; write #include \"lib/file.glsl\"", where);
    if (leaves_folders(*name)) {
      throw Error(
          from.blame,
          fmt::format("'{}' lies outside the program's shader folder; only files inside it are included", *name),
          where);
    }
    const auto found = find(*name);
    if (!found) throw Error(from.blame, describe_missing(*name), where);
    if (std::ranges::find(open_, found->key) != open_.end())
      throw Error(from.blame, fmt::format("'{}' includes itself, directly or through others", *name), where);
    if (done_.insert(found->key).second) append(*found);
    append_line_directive(number + 1, index);
    return true;
  }

  void append_line_directive(int line, std::size_t index) {
    const auto file = static_cast<int>(index);
    source_.text += fmt::format("#line {} {}\n", kLinesPerFile * file + line, file);
  }

  const SourceOptions& options_;
  ShaderSource source_;
  std::vector<std::string> open_;
  std::set<std::string> done_;
};

}  // namespace

ShaderSource build_source(const SourceOptions& options) { return Builder(options).build(); }

}  // namespace shadowbench::gl
