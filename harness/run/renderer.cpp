#include "harness/run/renderer.h"

namespace shadowbench::run {

Renderer make_renderer(gl::Backend backend, const Resources& resources) {
  gl::ContextChoice choice = gl::create_context(backend);
  const gl::TimerKind timer = gl::choose_timer(*choice.context);
  return {std::move(choice.context), std::move(choice.refused), timer, render::ShaderLibrary(resources.shaders)};
}

}  // namespace shadowbench::run
