#pragma once

#include <string>
#include <vector>

#include "filters/filter_spec.h"
#include "harness/render/bias/bias.h"
#include "harness/render/map_settings.h"
#include "harness/scene/lights/light_fit.h"

namespace shadowbench::render {

/// A length along the light in three units, whose parts add up.
struct BiasAmount {
  double depth = 0.0;   ///< [0,1] over the light's range
  double texels = 0.0;  ///< as long as so many shadow-map texels are wide
  double world = 0.0;   ///< metres

  double in_world(const scene::LightFrustum& frustum) const;  ///< metres
  double in_depth(const scene::LightFrustum& frustum) const;
};

/// The bias of a whole run. The parts add up; each filter gets its own share of `plane_kernels`, because the depth that
/// a plane gains under a kernel grows with the kernel.
struct BiasRule {
  BiasAmount constant{2e-5, 0.0, 0.0};
  BiasAmount slope;             ///< times 1 - n.l; the larger of this and `constant` holds
  double plane_texels = 0.0;    ///< depth change of the receiver's plane over this many texels
  double plane_kernels = 1.0;   ///< the same, in units of filters::bias_reach_texels()
  BiasAmount normal_offset;     ///< moves the receiver along its normal; `depth` is not used
  bool receiver_plane = false;  ///< the plane's gradient is added for every tap
  double max_tangent = 10.0;    ///< steeper planes are biased as this one
  render::MapBias map;

  /// The rule that does nothing.
  static BiasRule none();

  /// The steepest plane, as a tangent, that the receiver-plane bias of the scalar models follows; 0: there is no such
  /// bias.
  double plane_max_tangent() const { return receiver_plane ? max_tangent : 0.0; }
};

/// Parses `none`, or MODE:key=value,... with the modes constant, slope, plane, normal-offset, receiver-plane,
/// polygon-offset, front-cull and midpoint; several texts add up. An empty list means the default rule. Throws
/// Error(kUsage) for an unknown mode or key and for an amount that is negative or not finite.
BiasRule parse_bias(const std::vector<std::string>& texts);

/// Lists the modes with their keys, for help texts.
std::string list_bias_modes();

/// Why a filter cannot do what a rule asks for; empty where it can.
std::string explain_unusable(const BiasRule& rule, const filters::FilterSpec& spec);

/// Throws Error(kUsage), naming the filter, where a rule asks for something that a filter cannot do.
void require_usable(const BiasRule& rule, const filters::FilterSpec& spec);

/// Throws Error(kUsage) where a rule asks for something that cannot be drawn into a map of those settings.
void require_drawable(const BiasRule& rule, const render::MapSettings& map);

/// The bias of one filter under a rule.
render::Bias resolve_bias(const BiasRule& rule, const scene::LightFrustum& frustum, const filters::FilterSpec& spec,
                          const filters::ParamValues& values);

/// The bias that a percentage-closer filter with the same kernel gets under a rule. It is the own bias of filters that
/// compare. A bound that accounts for the slope itself (`bias_texels` less than `radius_texels`) has less, and a
/// comparison with so little bias would show acne.
render::Bias resolve_comparison_bias(const BiasRule& rule, const scene::LightFrustum& frustum,
                                     const filters::FilterSpec& spec, const filters::ParamValues& values);

}  // namespace shadowbench::render
