#include "harness/measure/renderer.h"

#include <algorithm>

#include "harness/gl/survey.h"

namespace shadowbench::measure {

Renderer make_renderer(gl::Backend backend, const options::Resources& resources) {
  gl::ContextChoice choice = gl::create_context(backend);
  const gl::TimerKind timer = gl::choose_timer(*choice.context);
  return {std::move(choice.context), std::move(choice.refused), timer, render::ShaderLibrary(resources.shaders)};
}

filters::GlAccuracy measure_accuracy(Renderer& renderer) {
  if (!renderer.accuracy) {
    const gl::GlSurvey measured = gl::survey_gl(*renderer.context);
    renderer.accuracy = {measured.exp_ulp, static_cast<double>(std::min(measured.rg32f.bits, measured.r32f.bits))};
  }
  return *renderer.accuracy;
}

}  // namespace shadowbench::measure
