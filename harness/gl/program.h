#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "harness/gl/handle.h"
#include "harness/gl/shader_log.h"
#include "harness/gl/shader_source.h"

namespace shadowbench::gl {

/// GLSL that does not compile or link; the message is the compiler's log.
class CompileError : public Error {
 public:
  CompileError(ErrorKind kind, std::string message, ShaderLog log)
      : Error(kind, std::move(message), std::move(log.where)), complaints_(std::move(log.complaints)) {}

  /// All that the compiler complained of, in its order.
  const std::vector<Complaint>& complaints() const { return complaints_; }

 private:
  std::vector<Complaint> complaints_;
};

/// Owns a linked program. Uniforms are set by name, at any time, without `use()`.
class Program {
 public:
  /// Compiles and links a vertex and a fragment shader, with a geometry shader between them where there is one.
  /// Throws on errors: with `blame` (kFilter where a user's file is part of it) CompileError of that kind, its `where`
  /// the first error's file and line; without, std::logic_error: a shader of ours that does not compile is a bug.
  Program(std::string_view label, const ShaderSource& vertex, const ShaderSource& fragment,
          std::optional<ErrorKind> blame = std::nullopt, const std::optional<ShaderSource>& geometry = std::nullopt);

  /// Makes it the program of the next draw.
  void use() const;

  /// Sets a uniform. One that the sources name but the compiler dropped is ignored.
  /// Throws std::logic_error for a name that no source contains.
  void set(std::string_view name, int value);
  void set(std::string_view name, std::uint32_t value);
  void set(std::string_view name, float value);
  void set(std::string_view name, const glm::ivec2& value);
  void set(std::string_view name, const glm::vec2& value);
  void set(std::string_view name, const glm::vec3& value);
  void set(std::string_view name, const glm::vec4& value);
  void set(std::string_view name, const glm::mat4& value);

  /// Whether the compiler kept a uniform of this name.
  bool has(std::string_view name) const;

  const std::string& label() const { return label_; }

  /// The last stage as it was compiled: the fragment shader of what draws.
  const ShaderSource& last_stage() const { return sources_.back(); }
  GLuint id() const { return handle_.id(); }

 private:
  GLint location(std::string_view name);

  std::string label_;
  Handle<GL_PROGRAM> handle_;
  std::vector<ShaderSource> sources_;
  std::map<std::string, GLint, std::less<>> locations_;
};

}  // namespace shadowbench::gl
