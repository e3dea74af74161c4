#pragma once

#include <string>

#include "harness/options/options.h"
#include "harness/options/progress.h"

namespace shadowbench::flicker {

/// The options of `shadowbench flicker`.
struct FlickerOptions {
  options::RunOptions run;  ///< one scene, one map size; fit and snap are the motion's
  std::string motions = "light,camera";
  int frames = 64;  ///< 2 or more
};

/// Moves the light and the camera of the scene's first view in steps smaller than a texel, looks the first frame's
/// receivers up in every frame's map with every filter, without snapping and with it, holds the changes of visibility
/// against those of the ray-traced truth, and writes flicker.html, .md, .json, .csv and pictures into the output
/// folder. Throws Error(kUsage) for motions that do not exist, Error(kInput) where nothing faces the light or turning
/// it moves nothing, Error as scene::load, render::FilterPasses and render::ShadowMap. Cost: one map, prefilter and
/// lookup per motion, snapping, frame and filter; the truth of every frame of the light, kept in the cache.
void run_flicker(const FlickerOptions& options, options::Progress& progress);

}  // namespace shadowbench::flicker
