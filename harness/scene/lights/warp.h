#pragma once

#include "harness/scene/lights/light_fit.h"

namespace shadowbench::scene {

/// Fits the sun's map to what the camera sees as FitMode::kView does, but with more texels where the camera is near:
/// u and v go through a projection whose lines of equal w are across the view direction. Depth stays linear along the
/// light, so that every filter works as ever. Of each method this is what makes it different:
///
/// - kFocused: none at all; the map fits the view's width and length by themselves. What the others are measured by.
/// - kLispsm: w grows along the view from n = (z_n + sqrt(z_n z_f)) / sin(gamma), where gamma is the angle between view
///   and light. Source: Wimmer, Scherzer and Purgathofer 2004, Light Space Perspective Shadow Maps, EGSR.
/// - kPsm: the projection that the camera's own perspective leads to, after which a light at infinity is a lamp; the
///   camera steps back until that lamp sees everything in view.
///   Source: Stamminger and Drettakis 2002, Perspective Shadow Maps, SIGGRAPH; the step back: Kozlov 2004, Perspective
///   Shadow Maps: Care and Feeding, GPU Gems 14.
/// - kTsm: n so that the nearest kTrapezoidFocus of the length gets four fifths of the map.
///   Source: Martin and Tan 2004, Anti-aliasing and Continuity with Trapezoidal Shadow Maps, EGSR.
/// - kLogpsm: u as in a perspective map of n = z_n / sin(gamma), v as the logarithm of w: texels grow with the distance
///   along both. Source: Lloyd, Govindaraju, Quammen, Molnar and Manocha 2008, Logarithmic Perspective Shadow Maps,
///   TOG.
///
/// Where the view is along the light, all are kFocused. Requires a camera. Throws kUsage for `snap`, which a map whose
/// texels change with the camera cannot do.
LightFrustum fit_warped(const Sun& sun, const Scene& scene, const FitRequest& request);

inline constexpr double kTrapezoidFocus = 0.25;

}  // namespace shadowbench::scene
