#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "harness/gl/objects.h"

namespace shadowbench::gl {

/// Line numbers tell the files apart: line 14 of file 2 is `#line 200014 2`. The index alone is not enough, since Mesa
/// reports file 0 for all errors but those of syntax.
inline constexpr int kLinesPerFile = 100'000;

/// One shader stage, ready to compile.
struct ShaderSource {
  std::string text;                ///< GLSL from `#version` on; `#line` directives say file and line, see kLinesPerFile
  std::vector<std::string> files;  ///< names for messages; 0 is what the program itself puts on top
};

/// Text that stands in for a file, such as a filter's GLSL without its front matter.
struct Piece {
  std::string include_name;  ///< what `#include "..."` calls it
  std::string text;
  std::string display_name;  ///< what messages call it: the file that the user wrote
  int first_line = 1;        ///< the number of `text`'s first line in that file
};

/// What `build_source` is to build.
struct SourceOptions {
  std::vector<std::filesystem::path> roots;                  ///< folders that includes are looked up in, in order
  std::string main_file;                                     ///< relative to a root, or a piece's include name
  std::vector<std::pair<std::string, std::string>> defines;  ///< name, value; put right after `#version`
  std::vector<Piece> pieces;                                 ///< taken before files of the same name
};

/// Puts a shader together: `#version 450 core`, the defines, then `main_file` with every `#include "..."` replaced by
/// what it names, once each. Every piece keeps its own line numbers.
/// Throws Error with file and line of the include: kFilter inside a piece, kInput in a file of ours; for a name that no
/// root has or that leaves the roots, a malformed include, a comment left open, a `#version` or a `#line` in the text,
/// a NUL byte, or a text of kLinesPerFile lines.
ShaderSource build_source(const SourceOptions& options);

/// Returns one of this folder's own shaders (shaders.glsl), which are compiled into the program: unlike those in
/// `shaders/` they belong to the GL layer, and it works without any folder at hand.
/// Throws std::logic_error for a name that is not there.
ShaderSource embedded_source(const std::string& name);

/// One line of a compiler's log.
struct Complaint {
  std::string file = {};  ///< of ShaderSource::files; empty where the driver named none
  int line = 0;
  std::string text = {};  ///< without the word error
  bool is_error = false;

  /// "file:line"
  std::string where() const;
};

/// A compiler's complaints in terms of the user's own files.
struct ShaderLog {
  std::string where;    ///< "file:line" of the first error, or empty where the driver named none
  std::string message;  ///< the first error without its place, then the other lines as "file:line: error: ..."
  std::vector<Complaint> complaints;  ///< all lines, in their order
};

/// Translates a driver's info log: "2:14(5): error: x" (Mesa), "2(14) : error C1: x" (NVIDIA) and
/// "ERROR: 2:14: x" (AMD, Intel, glslang), where 2 indexes `files` unless the line itself
/// does (kLinesPerFile above). Lines in no such form are kept as they are.
ShaderLog translate_log(std::string_view log, const std::vector<std::string>& files);

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

/// Draws one triangle that covers the viewport.
class FullscreenTriangle {
 public:
  FullscreenTriangle();

  /// Draws with the program and framebuffer in use, having turned off depth, stencil and scissor test, blending,
  /// culling and polygon offset, opened the colour mask, and set polygon mode to fill. No program is in use afterwards.
  void draw() const;

  /// The same where the framebuffer's depth is 0, adding what the program writes to what is there.
  void draw_added() const;

  /// The same without adding.
  void draw_masked() const;

  /// The same for a program that writes gl_FragDepth into a framebuffer's depth, whatever is there.
  void draw_depth() const;

  /// Returns the vertex shader that goes with it. Its output `vec2 v_uv` is (0,0) at the lower left of the viewport.
  static ShaderSource vertex_source();

 private:
  VertexArray empty_;

  void set_state() const;
  void set_masked() const;
  void draw_triangle() const;
};

}  // namespace shadowbench::gl
