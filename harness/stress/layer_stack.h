#pragma once

#include <vector>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {

/// Occluders one behind the other, all within every kernel, and a receiver behind them all: it is wholly blocked.
struct LayerStack {
  std::vector<double> depths;  ///< of the occluders, ascending
  double receiver = 1.0;       ///< depth, behind the last
};

/// Gives `count` occluders at equal distances whose first and last lie `first_gap` apart, and a receiver that lies
/// `gap_ratio` times that behind the last one, at depth `receiver`. Requires 2 occluders or more.
LayerStack make_layer_stack(int count, double first_gap, double gap_ratio, double receiver);

/// A map in which a stack's occluders take turns, texel by texel along rows and columns, and receivers in its middle.
struct LayerScene {
  SyntheticScene scene;
  std::vector<std::vector<double>>
      shares;  ///< of each receiver's kernel: what each occluder's texels weigh; they sum to 1
};

/// Makes one for a Gaussian prefilter of `radius_texels` and a map read with the bilinear tent, at texel centres; with
/// radius 0 between them, so that a kernel holds four texels: of more occluders than it has texels it holds some.
LayerScene make_layer_scene(int radius_texels, const LayerStack& stack);

/// The visibility of variance shadow maps by the Chebyshev bound: s2 / (s2 + (t - mu)^2), with the mean mu and
/// the variance s2 of the depths in the kernel, and the receiver's depth t behind the mean. Source: Donnelly and
/// Lauritzen 2006, Variance Shadow Maps, I3D, eq. 5.
double find_chebyshev(const LayerStack& stack, const std::vector<double>& shares);

/// The visibility of exponential shadow maps: the kernel's mean of exp(-c (t - z)).
/// Source: Annen et al. 2008, Exponential Shadow Maps, Graphics Interface, eq. 5.
double find_exponential(const LayerStack& stack, const std::vector<double>& shares, double c);

}  // namespace shadowbench::stress
