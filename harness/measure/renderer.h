#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/scalar.h"
#include "harness/gl/context/context.h"
#include "harness/gl/recorder.h"
#include "harness/gl/survey.h"
#include "harness/options/options.h"
#include "harness/render/shader_library.h"

namespace shadowbench::measure {

/// The GL context of a run with what was found out about it.
struct Renderer {
  std::unique_ptr<gl::Context> context;
  std::vector<std::string> refused;  ///< contexts that `auto` could not use, and why
  gl::TimerKind timer = gl::TimerKind::kWallClock;
  render::ShaderLibrary shaders;
  std::optional<filters::GlAccuracy> accuracy = std::nullopt;  ///< see measure_accuracy()
  std::unique_ptr<gl::Recorder> recorder = nullptr;            ///< only where what is drawn is written down
};

/// Makes a context and chooses its timer by measurement.
/// Throws Error(kContext).
Renderer make_renderer(gl::Backend backend, const options::Resources& resources);

/// How exact the GL's functions and filtering weights are, by experiment: what propagated rounding bounds start
/// from. Cost: under 2 s when first asked for, nothing then.
filters::GlAccuracy measure_accuracy(Renderer& renderer);

}  // namespace shadowbench::measure
