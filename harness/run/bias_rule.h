#pragma once

#include <string>
#include <vector>

#include "filters/filter_spec.h"
#include "harness/render/bias.h"

namespace shadowbench::run {

/// The bias of a whole run. The parts add up; each filter gets its own slope part from `slope_kernels`, because the
/// depth that a plane gains under a kernel grows with the kernel.
struct BiasRule {
  double constant_depth = 2e-5;        ///< depth, [0,1] over the light's range
  double slope_texels = 0.0;           ///< depth change of the receiver's plane over this many texels
  double slope_kernels = 1.0;          ///< the same, in units of the filter's kernel half-width plus one texel
  double normal_offset_texels = 0.0;   ///< moves the receiver along its normal
};

/// Parses `none`, or MODE:key=value,...: `constant:depth=D`, `slope:kernels=K,texels=T,depth=D`,
/// `normal-offset:texels=T`; several texts add up. Gives the default rule for an empty list.
/// Throws Error(kUsage) for an unknown mode or key and for an amount that is negative or not finite.
BiasRule parse_bias(const std::vector<std::string>& texts);

/// Gives the bias of one filter under a rule: slope (r + 1) texels per kernel, r from the front matter.
render::Bias resolve_bias(const BiasRule& rule, const filters::FilterSpec& spec, const filters::ParamValues& values);

/// Gives the bias that a percentage-closer filter of the same kernel gets under a rule. Filters that compare get it anyway;
/// a bound that takes the slope in by itself (`bias_texels` less than `radius_texels`) would show acne as a comparison.
render::Bias resolve_comparison_bias(const BiasRule& rule, const filters::FilterSpec& spec,
                                     const filters::ParamValues& values);

}  // namespace shadowbench::run
