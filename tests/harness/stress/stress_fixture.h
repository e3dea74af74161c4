#pragma once

#include <string>

#include "harness/stress/context.h"

namespace shadowbench::stress {

/// Makes a context of these filters without a GL.
inline StressContext make_context(const std::string& filters = "") {
  static const filters::Catalogue catalogue(options::find_resources().filters);
  StressContext context;
  context.resources = options::find_resources();
  context.filters = catalogue.parse_requests(filters);
  return context;
}

/// Gives the one renderer of a test program.
inline measure::Renderer& shared_renderer() {
  static measure::Renderer renderer = measure::make_renderer(gl::Backend::kAuto, options::find_resources());
  return renderer;
}

/// The same with a GL.
inline StressContext make_gl_context(const std::string& filters) {
  StressContext context = make_context(filters);
  context.renderer = &shared_renderer();
  return context;
}

}  // namespace shadowbench::stress
