// Stands in for the back ends whose development packages were not found when this was configured.
#include "filters/base/error.h"
#include "harness/gl/context/context_backends.h"

namespace shadowbench::gl {
namespace {

[[maybe_unused]] std::unique_ptr<Context> refuse() {
  throw Error(ErrorKind::kContext, "this build has no such back end: its development package was missing");
}

}  // namespace

#ifndef SHADOWBENCH_HAS_OSMESA
std::unique_ptr<Context> create_osmesa_context() { return refuse(); }
#endif
#ifndef SHADOWBENCH_HAS_EGL
std::unique_ptr<Context> create_egl_context() { return refuse(); }
std::unique_ptr<Context> create_egl_gpu_context() { return refuse(); }
#endif
#ifndef SHADOWBENCH_HAS_GLFW
std::unique_ptr<Context> create_glfw_context() { return refuse(); }
#endif

}  // namespace shadowbench::gl
