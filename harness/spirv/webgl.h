#pragma once

#include <string>

#include "harness/gl/program.h"
#include "harness/spirv/spirv.h"

namespace shadowbench::spirv {

/// Whether this build has what the translation needs.
bool can_translate_to_webgl();

/// Translates a shader's GLSL 4.50 into that of WebGL 2 (GLSL ES 3.00): its uniforms, inputs and outputs keep their
/// names, clip space is OpenGL's of old (depth -1 to 1), bindings of samplers are gone. In the text WEBGL is defined.
/// May run on several threads at once. Throws Error(kFilter) where WebGL 2 lacks something, naming it. Requires
/// can_translate_to_webgl().
std::string translate_to_webgl(const gl::ShaderSource& source, Stage stage);

}  // namespace shadowbench::spirv
