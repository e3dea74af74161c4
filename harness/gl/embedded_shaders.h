#pragma once

#include <string>

#include "harness/gl/shader_source.h"

namespace shadowbench::gl {

/// Returns one of this folder's own shaders (`*.vert`, `*.frag`), which are compiled into the program: unlike those in
/// `shaders/` they belong to the GL layer, and it works without any folder at hand.
/// Throws std::logic_error for a name that is not there.
ShaderSource embedded_source(const std::string& name);

}  // namespace shadowbench::gl
