#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/gl/gl_api.h"

namespace shadowbench::gl {

/// Returns the token's name, e.g. "GL_OUT_OF_MEMORY".
std::string gl_error_name(GLenum error);

/// Returns and clears every pending glGetError code.
std::vector<GLenum> drain_gl_errors();

/// Checks for errors of the allocation that was just made; `what` names it ("texture 'depth map'"). Throws
/// Error(kContext) for GL_OUT_OF_MEMORY, std::logic_error for any other pending error.
void require_allocated(std::string_view what);

}  // namespace shadowbench::gl
