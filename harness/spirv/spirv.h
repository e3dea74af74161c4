#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/gl/program.h"

namespace shadowbench::spirv {

/// Whose rules GLSL is compiled by: Vulkan's, with loose uniforms put into a block, or those of OpenGL.
enum class Rules { kVulkan, kOpenGl };

enum class Stage { kVertex, kFragment };

/// What a shader binds at a place of its only descriptor set.
struct Binding {
  std::uint32_t place = 0;
  bool is_texture = false;  ///< else a block of uniforms
};

/// A compiled shader stage.
struct Shader {
  std::vector<std::uint32_t> words;
  std::vector<Binding> bindings;
};

/// Compiles the GLSL that OpenGL is given, for Vulkan 1.3 or OpenGL 4.5. May run on several threads at once.
/// Throws Error(kFilter) with file and line for what those rules refuse.
Shader compile(const gl::ShaderSource& source, Stage stage, Rules rules);

/// Whether this build has what the translation needs.
bool can_translate_to_webgl();

/// Translates a shader's GLSL 4.50 into that of WebGL 2 (GLSL ES 3.00): its uniforms, inputs and outputs keep their
/// names, clip space is OpenGL's of old (depth -1 to 1), bindings of samplers are gone. In the text WEBGL is defined.
/// May run on several threads at once. Throws Error(kFilter) where WebGL 2 lacks something, naming it. Requires
/// can_translate_to_webgl().
std::string translate_to_webgl(const gl::ShaderSource& source, Stage stage);

}  // namespace shadowbench::spirv
