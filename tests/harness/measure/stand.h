#pragma once

#include <string>
#include <utility>

#include "harness/measure/scene_assets.h"
#include "harness/options/options.h"
#include "reference/truth/cached_tracer.h"
#include "tests/filters/filtered.h"

namespace shadowbench::test {

/// The one renderer of a test program, made current: a test before this one may have had a context of its own.
inline measure::Renderer& shared_renderer() {
  static measure::Renderer renderer = measure::make_renderer(gl::Backend::kAuto, options::find_resources());
  renderer.context->make_current();
  return renderer;
}

/// Pictures of this size of built-in scenes, timed once against `none`.
inline options::RunOptions make_run_options(int width, int height) {
  options::RunOptions options;
  options.resources = options::find_resources();
  options.width = width;
  options.height = height;
  options.sizes = {{width, height}};
  options.rounds = options::RoundLimits::exactly(1);
  options.reference = filters::request_of("none");
  return options;
}

/// A scene with all that is measured with.
struct Stand {
  Stand(scene::Scene shown, options::RunOptions told, double pad_texels)
      : scene(std::move(shown)), options(std::move(told)), assets(renderer, options, scene, cache, pad_texels) {}

  scene::Scene scene;
  options::RunOptions options;
  measure::Renderer& renderer = shared_renderer();
  truth::TruthCache cache{{}, [](const std::string&) {}};
  measure::SceneAssets assets;
};

}  // namespace shadowbench::test
