#include "harness/gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace shadowbench::gl {
namespace {

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

bool is_word_character(char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; }

bool contains_word(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool starts = at == 0 || !is_word_character(text[at - 1]);
    if (starts && (end == text.size() || !is_word_character(text[end]))) return true;
  }
  return false;
}

}  // namespace

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
    const auto declares = [&](const ShaderSource& source) { return contains_word(source.text, base); };
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

}  // namespace shadowbench::gl
