#include "harness/gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>

#include "base/error.h"
#include "filters/glsl_words.h"

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
    done_.insert(found->key);
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
  std::set<std::string> done_;
};

constexpr std::string_view kErrorWord = "error: ";  ///< which the caller's sentence has already

/// What a line says by itself.
struct LogLine {
  int index = 0;
  int line = 0;
  std::size_t text_at = 0;
};

// Widths keep the numbers inside an int; a blank matches any blanks, or none.
std::optional<LogLine> read_log_line(const std::string& line) {
  LogLine read;
  int end = 0;
  // Mesa      2:14(5): error: x
  if (std::sscanf(line.c_str(), "%9d:%9d(%*9d): %n", &read.index, &read.line, &end) != 2 || end == 0) {
    constexpr std::array kForms = {
        "%9d(%9d) : %n",         // NVIDIA    2(14) : error C1008: x
        "ERROR: %9d:%9d: %n",    // others    ERROR: 2:14: x
        "WARNING: %9d:%9d: %n",  //
    };
    for (const char* form : kForms) {
      read = {};
      if (std::sscanf(line.c_str(), form, &read.index, &read.line, &end) == 2 && end > 0) break;
      end = 0;
    }
  }
  read.text_at = static_cast<std::size_t>(end);
  return end > 0 ? std::optional(read) : std::nullopt;
}

// Takes the file from the line number, or from the driver's index where the number says nothing.
std::optional<std::size_t> find_file(const LogLine& log_line, const std::vector<std::string>& files) {
  if (log_line.index < 0 || log_line.line < 0) return std::nullopt;
  const auto file =
      static_cast<std::size_t>(log_line.line >= kLinesPerFile ? log_line.line / kLinesPerFile : log_line.index);
  return file < files.size() ? std::optional(file) : std::nullopt;
}

/// A line with its place; as it is where it has none. `text` begins with the word error or warning still.
Complaint parse_line(const std::string& line, const std::vector<std::string>& files) {
  const auto log_line = read_log_line(line);
  const auto file = log_line ? find_file(*log_line, files) : std::nullopt;
  if (!file) return {.text = line, .is_error = line.find("error") != std::string::npos || line.starts_with("ERROR")};
  Complaint complaint{files[*file], log_line->line % kLinesPerFile, line.substr(log_line->text_at)};
  const std::string& text = complaint.text;
  complaint.is_error = line.starts_with("ERROR") || text.starts_with("error") || text.starts_with("fatal error") ||
                       text.starts_with("preprocessor error");
  return complaint;
}

using Shader = Handle<GL_SHADER>;

std::string read_log(GLuint id, decltype(glGetShaderInfoLog) read, GLint length) {
  std::string log(static_cast<std::size_t>(length), '\0');
  GLsizei written = 0;
  if (length > 0) read(id, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

[[noreturn]] void fail(std::string_view what, const std::string& log, const std::vector<std::string>& files,
                       std::optional<ErrorKind> blame) {
  ShaderLog translated = translate_log(log, files);
  if (translated.message.empty()) translated.message = "the driver gives no reason";
  const std::string message = fmt::format("{}: {}", what, translated.message);
  if (blame) throw CompileError(*blame, message, std::move(translated));
  throw std::logic_error(translated.where.empty() ? message : translated.where + ": " + message);
}

Shader compile(std::string_view label, GLenum type, const ShaderSource& source, std::optional<ErrorKind> blame) {
  Shader shader(label, type);
  const char* text = source.text.data();
  const auto length = static_cast<GLint>(source.text.size());
  glShaderSource(shader.id(), 1, &text, &length);
  glCompileShader(shader.id());
  GLint ok = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  GLint log_length = 0;
  glGetShaderiv(shader.id(), GL_INFO_LOG_LENGTH, &log_length);
  fail(fmt::format("the GLSL of '{}' does not compile", label), read_log(shader.id(), glGetShaderInfoLog, log_length),
       source.files, blame);
}

}  // namespace

ShaderSource build_source(const SourceOptions& options) { return Builder(options).build(); }

extern const std::string_view kOwnShaders;  // shaders.glsl

ShaderSource embedded_source(const std::string& name) {
  const std::string mark = "\n//: ", heading = mark + name + "\n";
  const std::size_t at = kOwnShaders.find(heading);
  if (at == std::string_view::npos) throw std::logic_error("no embedded shader '" + name + "'");
  const std::string_view before = kOwnShaders.substr(0, at + heading.size()), rest = kOwnShaders.substr(before.size());
  const auto first_line = static_cast<int>(std::ranges::count(before, '\n')) + 1;
  SourceOptions options;
  options.main_file = name;
  options.pieces = {{name, std::string(rest.substr(0, rest.find(mark))), "harness/gl/shaders.glsl", first_line}};
  return build_source(options);
}

std::string Complaint::where() const { return file.empty() ? "" : fmt::format("{}:{}", file, line); }

ShaderLog translate_log(std::string_view log, const std::vector<std::string>& files) {
  ShaderLog result;
  std::string others;
  while (!log.empty()) {
    const std::size_t end = log.find('\n');
    std::string line(log.substr(0, end));
    log.remove_prefix(end == std::string_view::npos ? log.size() : end + 1);
    while (!line.empty() && (line.back() == '\r' || line.back() == '\0' || line.back() == ' ')) line.pop_back();
    if (line.empty()) continue;
    Complaint complaint = parse_line(line, files);
    const std::string told = complaint.text;
    if (!complaint.file.empty() && told.starts_with(kErrorWord)) complaint.text.erase(0, kErrorWord.size());
    if (result.message.empty() && complaint.is_error) {
      result.where = complaint.where();
      result.message = complaint.text;
    } else {
      others += complaint.file.empty() ? "\n" + line : fmt::format("\n{}: {}", complaint.where(), told);
    }
    result.complaints.push_back(std::move(complaint));
  }
  result.message += others;
  if (result.message.starts_with('\n')) result.message.erase(0, 1);
  return result;
}

Program::Program(std::string_view label, const ShaderSource& vertex, const ShaderSource& fragment,
                 std::optional<ErrorKind> blame, const std::optional<ShaderSource>& geometry)
    : label_(label), handle_(label) {
  std::vector<Shader> shaders;
  const auto attach = [&](GLenum type, const ShaderSource& source) {
    shaders.push_back(compile(label_, type, source, blame));
    glAttachShader(id(), shaders.back().id());
    sources_.push_back(source);
  };
  attach(GL_VERTEX_SHADER, vertex);
  if (geometry) attach(GL_GEOMETRY_SHADER, *geometry);
  attach(GL_FRAGMENT_SHADER, fragment);
  glLinkProgram(id());
  for (const Shader& shader : shaders) glDetachShader(id(), shader.id());
  GLint ok = GL_FALSE;
  glGetProgramiv(id(), GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return;
  GLint log_length = 0;
  glGetProgramiv(id(), GL_INFO_LOG_LENGTH, &log_length);
  // A link error belongs to no single stage; the last stage is where a filter's code is.
  fail(fmt::format("the GLSL of '{}' does not link", label_), read_log(id(), glGetProgramInfoLog, log_length),
       fragment.files, blame);
}

void Program::use() const { glUseProgram(id()); }

bool Program::has(std::string_view name) const { return glGetUniformLocation(id(), std::string(name).c_str()) >= 0; }

GLint Program::location(std::string_view name) {
  const auto known = locations_.find(name);
  if (known != locations_.end()) return known->second;
  const GLint found = glGetUniformLocation(id(), std::string(name).c_str());
  if (found < 0) {
    const std::string_view base = name.substr(0, name.find_first_of(".["));  // `lights` of "lights[0].color"
    const auto declares = [&](const ShaderSource& source) { return filters::has_word(source.text, base); };
    if (std::ranges::none_of(sources_, declares))
      throw std::logic_error(fmt::format("program '{}' has no uniform '{}'", label_, name));
  }
  locations_.emplace(name, found);
  return found;
}

void Program::set(std::string_view name, int value) { glProgramUniform1i(id(), location(name), value); }

void Program::set(std::string_view name, std::uint32_t value) { glProgramUniform1ui(id(), location(name), value); }

void Program::set(std::string_view name, float value) { glProgramUniform1f(id(), location(name), value); }

void Program::set(std::string_view name, const glm::ivec2& value) {
  glProgramUniform2i(id(), location(name), value.x, value.y);
}

void Program::set(std::string_view name, const glm::vec2& value) {
  glProgramUniform2fv(id(), location(name), 1, &value[0]);
}

void Program::set(std::string_view name, const glm::vec3& value) {
  glProgramUniform3fv(id(), location(name), 1, &value[0]);
}

void Program::set(std::string_view name, const glm::vec4& value) {
  glProgramUniform4fv(id(), location(name), 1, &value[0]);
}

void Program::set(std::string_view name, const glm::mat4& value) {
  glProgramUniformMatrix4fv(id(), location(name), 1, GL_FALSE, &value[0][0]);
}

FullscreenTriangle::FullscreenTriangle() : empty_("fullscreen triangle") {}

void FullscreenTriangle::set_state() const {
  for (const GLenum capability : {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_BLEND, GL_CULL_FACE,
                                  GL_POLYGON_OFFSET_FILL, GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP})
    glDisable(capability);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  empty_.bind();
}

void FullscreenTriangle::draw() const {
  set_state();
  draw_triangle();
}

void FullscreenTriangle::draw_added() const {
  set_masked();
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  draw_triangle();
}

void FullscreenTriangle::draw_masked() const {
  set_masked();
  draw_triangle();
}

/// The triangle lies at depth 0.
void FullscreenTriangle::set_masked() const {
  set_state();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
}

void FullscreenTriangle::draw_depth() const {
  set_state();
  glEnable(GL_DEPTH_TEST);  // without the test there is no writing either
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  draw_triangle();
}

/// No program stays in use: at a later clear NVIDIA's driver would check its samplers against textures that are gone.
void FullscreenTriangle::draw_triangle() const {
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glUseProgram(0);
}

ShaderSource FullscreenTriangle::vertex_source() { return embedded_source("fullscreen.vert"); }

}  // namespace shadowbench::gl
