#include "harness/render/shader_library.h"

#include "harness/gl/fullscreen.h"

namespace shadowbench::render {
namespace {

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
  const std::string name = variant_name(fragment_file, defines);
  const auto found = programs_.find(name);
  if (found != programs_.end()) return found->second;
  ++compiled_;
  gl::Program program(name, gl::FullscreenTriangle::vertex_source(), source(fragment_file, defines, {}));
  return programs_.emplace(name, std::move(program)).first->second;
}

gl::Program& ShaderLibrary::geometry(const std::string& shader, const Defines& defines) {
  const std::string name = variant_name(shader, defines);
  const auto found = programs_.find(name);
  if (found != programs_.end()) return found->second;
  ++compiled_;
  gl::Program program(name, source(shader + ".vert", defines, {}), source(shader + ".frag", defines, {}));
  return programs_.emplace(name, std::move(program)).first->second;
}

gl::Program ShaderLibrary::compile_filter(const std::string& label, const std::string& fragment_file,
                                          const Defines& defines, const std::vector<gl::Piece>& pieces) {
  ++compiled_;
  return gl::Program(label, gl::FullscreenTriangle::vertex_source(), source(fragment_file, defines, pieces),
                     ErrorKind::kFilter);
}

}  // namespace shadowbench::render
