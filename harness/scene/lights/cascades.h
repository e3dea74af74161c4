#pragma once

#include <vector>

#include "harness/scene/lights/light_fit.h"

namespace shadowbench::scene {

/// The depths at which cascades meet, metres from the camera along its axis; the first is where they begin and the last
/// where they end. With split 0 all are as deep, with 1 each is as many times deeper than the one before; else this is
/// the mean of both, weighted by `split`.
/// Source: Zhang, Sun, Xu and Lun 2006, Parallel-Split Shadow Maps for Large-Scale Virtual Environments, VRCIA, eq. 7.
/// Requires 0 < near_m < far_m.
std::vector<double> split_depths(const CascadeRule& rule, double near_m, double far_m);

/// Fits a layer of the sun's map to each slice of what the camera sees; see fit_layers().
std::vector<LightFrustum> fit_cascades(const Sun& sun, const Scene& scene, const FitRequest& request);

}  // namespace shadowbench::scene
