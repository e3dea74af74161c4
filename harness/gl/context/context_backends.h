#pragma once

#include <cstddef>
#include <memory>

#include "harness/gl/context/context.h"

namespace shadowbench::gl {

// One function for each way to get a context, null where this build leaves it out. Each returns a context that is
// current, or throws Error(kContext) with the reason.
#ifdef SHADOWBENCH_HAS_OSMESA
std::unique_ptr<Context> create_osmesa_context();
#else
inline constexpr std::nullptr_t create_osmesa_context = nullptr;
#endif

#ifdef SHADOWBENCH_HAS_EGL
std::unique_ptr<Context> create_egl_context();
/// Like create_egl_context, but refuses software rasterisers.
std::unique_ptr<Context> create_egl_gpu_context();
/// Like create_egl_context, but refuses GPUs.
std::unique_ptr<Context> create_egl_software_context();
#else
inline constexpr std::nullptr_t create_egl_context = nullptr, create_egl_gpu_context = nullptr,
                                create_egl_software_context = nullptr;
#endif

#ifdef SHADOWBENCH_HAS_WINDOW
std::unique_ptr<Context> create_glfw_context();
#else
inline constexpr std::nullptr_t create_glfw_context = nullptr;
#endif

}  // namespace shadowbench::gl
