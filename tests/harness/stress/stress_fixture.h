#pragma once

#include <string>

#include "harness/stress/axis_inputs.h"

namespace shadowbench::stress {

/// Makes a inputs of these filters without a GL.
inline AxisInputs make_inputs(const std::string& filters = "") {
  static const filters::Catalogue catalogue(options::find_resources().filters);
  AxisInputs inputs;
  inputs.resources = options::find_resources();
  inputs.filters = catalogue.parse_requests(filters);
  return inputs;
}

/// Gives the one renderer of a test program.
inline measure::Renderer& shared_renderer() {
  static measure::Renderer renderer = measure::make_renderer(gl::Backend::kAuto, options::find_resources());
  renderer.context->make_current();
  return renderer;
}

/// The same with a GL.
inline AxisInputs make_gl_inputs(const std::string& filters) {
  AxisInputs inputs = make_inputs(filters);
  inputs.renderer = &shared_renderer();
  return inputs;
}

}  // namespace shadowbench::stress
