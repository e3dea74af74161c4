#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/gl/context.h"
#include "harness/gl/timer.h"
#include "harness/render/shader_library.h"
#include "harness/run/options.h"

namespace shadowbench::run {

/// The GL context of a run with what was found out about it.
struct Renderer {
  std::unique_ptr<gl::Context> context;
  std::vector<std::string> refused;  ///< contexts that `auto` could not use, and why
  gl::TimerKind timer = gl::TimerKind::kWallClock;
  render::ShaderLibrary shaders;
};

/// Makes a context and chooses its timer by measurement.
/// Throws Error(kContext).
Renderer make_renderer(gl::Backend backend, const Resources& resources);

}  // namespace shadowbench::run
