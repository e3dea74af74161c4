#pragma once

#include <memory>

#include "harness/gl/context/context.h"

namespace shadowbench::gl {

// One function per way to get a context; each throws Error(kContext) with the reason where it does not work, which for
// a back end that this build leaves out is just that. The context comes back current.
std::unique_ptr<Context> create_osmesa_context();
std::unique_ptr<Context> create_egl_context();
/// Like create_egl_context, but refuses software rasterisers.
std::unique_ptr<Context> create_egl_gpu_context();
std::unique_ptr<Context> create_glfw_context();

}  // namespace shadowbench::gl
