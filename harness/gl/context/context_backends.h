#pragma once

#include <memory>

#include "harness/gl/context/context.h"

namespace shadowbench::gl {

// One function for each way to get a context. Each returns a context that is current, or throws Error(kContext) with
// the reason, also for a back end that this build leaves out.
std::unique_ptr<Context> create_osmesa_context();
std::unique_ptr<Context> create_egl_context();
/// Like create_egl_context, but refuses software rasterisers.
std::unique_ptr<Context> create_egl_gpu_context();
std::unique_ptr<Context> create_glfw_context();

}  // namespace shadowbench::gl
