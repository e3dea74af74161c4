#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/gl/program.h"

namespace shadowbench::render {

/// Says what is wrong with a filter, in terms of its own file: for each complaint the file and line, what is meant, and
/// the line as it stands there. Unknown names are followed by near ones among those that a filter may use. What the
/// compiler concludes from an error before it in the same line is left out. `pieces` are those of filter_pieces(), and
/// `shader` is what was compiled of them.
Error explain_mistakes(const gl::CompileError& error, const std::vector<gl::Piece>& pieces,
                       const gl::ShaderSource& shader);

using Defines = std::vector<std::pair<std::string, std::string>>;

/// The define for triangles that the fragment shader bounds.
inline const Defines::value_type kExactEdges = {"EXACT_EDGES", "1"};

/// Compiles the project's own shaders, each variant when it is first asked for, and counts them.
class ShaderLibrary {
 public:
  explicit ShaderLibrary(std::filesystem::path shader_folder) : folder_(std::move(shader_folder)) {}

  /// A fragment program over the full-screen triangle.
  gl::Program& fullscreen(const std::string& fragment_file, const Defines& defines = {});

  /// A program that draws geometry: `<name>.vert` and `<name>.frag`, and with kExactEdges `<name>.geom`.
  gl::Program& geometry(const std::string& name, const Defines& defines = {});

  /// Compiles a full-screen program that contains a filter's GLSL as the include "filter".
  /// Throws Error(kFilter) with the line of the filter's file.
  gl::Program compile_filter(const std::string& label, const std::string& fragment_file, const Defines& defines,
                             const std::vector<gl::Piece>& pieces);

  int compiled() const { return compiled_; }

 private:
  std::filesystem::path folder_;
  std::map<std::string, gl::Program> programs_;
  int compiled_ = 0;

  /// The variant of a program, compiled where there is none yet.
  gl::Program& keep(const std::string& name, const Defines& defines, const std::function<gl::Program()>& compile);
  gl::ShaderSource source(const std::string& file, const Defines& defines, const std::vector<gl::Piece>& pieces) const;
};

}  // namespace shadowbench::render
