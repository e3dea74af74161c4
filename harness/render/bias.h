#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "filters/depth_map.h"
#include "filters/filter_spec.h"
#include "filters/receiver.h"
#include "harness/gl/gl_api.h"
#include "harness/scene/lights/light_fit.h"
#include "report/records/records.h"

namespace shadowbench::render {

/// How a depth map holds transparent casters.
enum class BlendCasters {
  kOpaque,  ///< as any other
  kHashed,  ///< in texels by a hash of the place on the surface: lib/blend_casters.glsl
  kDither,  ///< in texels by a matrix of 8 x 8
};

constexpr auto names_of(BlendCasters) { return std::array{"opaque", "hashed", "dither"}; }

/// How a depth map stores depth.
struct MapSettings {
  GLenum format = GL_DEPTH_COMPONENT32F;  ///< or GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24
  filters::DepthCurve curve{};            ///< floats are finest near 0, perspective depth is coarsest far away
  BlendCasters blend_casters = BlendCasters::kOpaque;
};

/// How far a receiver is moved towards the light before it is compared. Of the first two parts the larger one counts;
/// the others are added to it.
struct Bias {
  double constant_depth = 0.0;        ///< in depth, [0,1] over the light's range
  double slope_depth = 0.0;           ///< times 1 - n.l, in depth
  double plane_texels = 0.0;          ///< the receiver plane's depth change over this many shadow-map texels
  double plane_kernels = 0.0;         ///< the part of that per texel of a filter's reach
  double normal_offset_texels = 0.0;  ///< along the normal, texels times the sine of the angle to the light
  bool receiver_plane = false;        ///< every tap is compared with the receiver plane's depth there, not here
  double max_tangent = 10.0;          ///< planes steeper than this towards the light are biased as this one

  bool operator==(const Bias&) const = default;
};

using records::BiasAmount, records::MapBias;

/// An amount in metres, and in depth.
double in_world(const BiasAmount& amount, const scene::LightFrustum& frustum);
double in_depth(const BiasAmount& amount, const scene::LightFrustum& frustum);

/// The bias of a whole run. Each filter gets its own share of `plane_kernels`, because the depth that a plane gains
/// under a kernel grows with the kernel.
struct BiasRule : records::BiasRecord {
  BiasRule() {
    constant.depth = 2e-5;
    plane_kernels = 1.0;
  }

  double max_tangent = 10.0;  ///< steeper planes are biased as this one

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

/// What theory asks of a kernel that reaches so many texels, on a plane.
struct BiasTheory {
  double reach_texels = 0.0;     ///< from the receiver to the centre of the farthest texel that counts, per axis
  double slope_per_texel = 0.0;  ///< |dz/du| + |dz/dv|, in depth
  double larger_slope = 0.0;     ///< the larger of the two
  double n_dot_l = 1.0;
  double texel_m = 0.0;  ///< at the receiver: under a lamp it grows with the distance

  /// How far the plane's depth changes within the kernel; what an offset along the light has to cover.
  double depth() const { return reach_texels * slope_per_texel; }
};

/// The theory of a kernel with this reach on a receiver's plane.
BiasTheory make_theory(double reach_texels, const filters::Receiver& receiver);

/// One mode of bias: how it is asked for, and how it is swept.
struct BiasMode {
  using Target = double& (*)(BiasRule&);
  using Theory = double (*)(const BiasTheory&);

  std::string name;                         ///< as `--bias` has it
  std::map<std::string, Target> keys = {};  ///< its amounts, and where they go
  void (*begin)(BiasRule&) = nullptr;       ///< switches on what needs no amount, but slack for rounding
  std::string key = {};                     ///< whose amount is swept; empty: the mode takes none
  std::string meaning = {};                 ///< one sentence
  Theory amount = nullptr;                  ///< theoretical, in the key's unit
  Theory lift_depth = nullptr;              ///< how far that moves a receiver with these slopes, in depth

  bool needs_amount() const { return !begin && !keys.empty(); }

  /// The rule that `--bias NAME:KEY=amount` stands for; `amount` is not used where the mode takes none.
  BiasRule make_rule(double amount) const;
};

/// The theory of the receiver that needs more of a mode than a `share` of all receivers do. Of two that need the same,
/// the one on the steeper plane counts as needing more. Requires a mode with an amount, and receivers.
BiasTheory find_theory(const BiasMode& mode, double reach_texels, const std::vector<filters::Receiver>& receivers,
                       double share);

/// All modes: `none`, then those whose amount is swept, then those without one.
const std::vector<BiasMode>& bias_modes();

/// All but `none`.
inline std::span<const BiasMode> swept_modes() { return std::span(bias_modes()).subspan(1); }

}  // namespace shadowbench::render
