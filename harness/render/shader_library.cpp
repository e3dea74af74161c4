#include "harness/render/shader_library.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "harness/gl/fullscreen.h"
#include "harness/render/filter_mistakes.h"

namespace shadowbench::render {
namespace {

/// Names a variant for people and drivers, who do not need the values.
std::string variant_name(const std::string& file, const Defines& defines) {
  std::string name = file;
  for (const auto& [key, value] : defines) name += " " + key;
  return name;
}

}  // namespace

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
