#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "filters/model.h"
#include "harness/render/filter_passes.h"
#include "harness/render/geometry.h"
#include "harness/render/shadow_map.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// Sizes of what a filter reads and writes.
struct BenchSize {
  int map = 0;  ///< texels per side
  int width = 0;
  int height = 1;
  bool operator==(const BenchSize&) const = default;
};

/// One filter with the shadow map that it reads, the G-buffer of its receivers and the picture that it writes.
class FilterBench {
 public:
  /// Requires inputs.renderer, which outlives the bench. Nothing is compiled or allocated before resize(). Screen
  /// passes run where the receivers are a picture.
  FilterBench(const AxisInputs& inputs, filters::FilterRequest request, bool is_picture = false);

  /// Allocates map, G-buffer and picture; keeps those that have this size.
  /// Throws Error as render::ShadowMap.
  void resize(const BenchSize& size);

  render::ShadowMap& map() { return surfaces_->map; }
  render::GBuffer& gbuffer() { return surfaces_->gbuffer; }
  render::ShaderLibrary& shaders() { return shaders_; }
  const filters::FilterRequest& request() const { return request_; }

  /// Puts receivers into the G-buffer, row by row, all with one normal.
  void upload_receivers(const std::vector<glm::vec3>& positions_ws, const glm::vec3& normal_ws);

  /// Runs the filter's passes with these parameter values; compiles them first where that is needed. Gives the
  /// visibility of each receiver. Throws Error as render::FilterPasses.
  std::vector<float> look_up(const render::LightSetup& light, const filters::ParamValues& values);

  /// Counts the texels of the encoded map that overflowed. Call after look_up().
  std::int64_t count_broken_texels();

 private:
  struct Surfaces {
    explicit Surfaces(const BenchSize& size)
        : map(size.map),
          gbuffer(size.width, size.height),
          target("stress visibility", GL_R32F, size.width, size.height) {}
    render::ShadowMap map;
    render::GBuffer gbuffer;
    render::ImageTarget target;
  };

  render::ShaderLibrary& shaders_;
  filters::FilterRequest request_;
  BenchSize size_;
  std::optional<Surfaces> surfaces_;
  std::optional<render::FilterPasses> passes_;
};

/// Makes the frustum of a light that looks along z over a map so wide; receivers' (x, y, z) are u, v and depth.
scene::LightFrustum make_axis_frustum(double width_ws, int map_texels);

/// A depth map that is made of numbers, not drawn, and receivers that are looked up in it.
struct SyntheticScene {
  int size = 0;               ///< texels per side of the map
  std::vector<float> depths;  ///< size * size, row 0 at v = 0
  std::vector<glm::vec3>
      receivers;  ///< u, v, depth, each in [0,1] inside the map; they face the light, and no bias is applied

  /// The uv of a texel's centre.
  float uv(int texel) const { return (static_cast<float>(texel) + 0.5f) / static_cast<float>(size); }
};

/// The normal of such receivers.
inline constexpr glm::vec3 kFacingLight{0.0f, 0.0f, -1.0f};

/// The i-th receiver as a model sees it, for a light without size.
filters::Receiver make_receiver(const SyntheticScene& scene, std::size_t i);

/// The depths of a map whose left half, the middle column included, has one depth and whose right half another.
std::vector<float> make_split_depths(int size, float left, float right);

/// What a filter makes of a synthetic scene.
struct LookupResult {
  std::vector<double> visibility;  ///< of the receivers, in their order
  std::int64_t broken_texels = 0;  ///< of the encoded map: overflown; 0 for models, which keep their map
};

/// A filter that is looked up in synthetic scenes, compiled once. Takes numeric parameters that are not const; texts,
/// such as the store, stay those of the construction.
using SyntheticLookup = std::function<LookupResult(const SyntheticScene& scene, const filters::ParamValues& values)>;

/// Looks up by the passes of harness/render: encode, blur, lookup.
/// Requires inputs.renderer, which outlives the lookup. Nothing is compiled or allocated before the first look, which
/// throws Error as render::FilterPasses and render::ShadowMap.
SyntheticLookup make_gl_lookup(const AxisInputs& inputs, const filters::FilterRequest& request);

/// Looks up by the filter's scalar model. Requires a filter that has one.
SyntheticLookup make_model_lookup(const AxisInputs& inputs, const filters::FilterRequest& request,
                                  filters::Precision precision = filters::Precision::kFloat);

/// The precision in which a filter's scalar model says what the GL must see. It is exact, but for filters that pack
/// numbers into whole ones, in steps far wider than those of floats: in single precision their models take the same
/// steps. |seen - exact| <= |seen - packed| + |packed - exact|, and what a filter loses by packing, the second, is no
/// matter of an axis that changes the map.
filters::Precision expected_precision(const filters::FilterSpec& spec);

/// What a filter's scalar model makes, in double, of a receiver before a map of one depth: the same for every size of
/// map and for every place whose kernel lies inside. Requires a filter that has a model.
double look_at_one_depth(const AxisInputs& inputs, const filters::FilterRequest& request, float stored, float receiver);

/// Makes the lookup of a case. Requires that the case is available; see start_case().
SyntheticLookup make_lookup(const AxisInputs& inputs, const filters::FilterRequest& request, Level level);

/// What an observation is held against.
struct Expected {
  std::vector<double> visibility;  ///< of the receivers, in exact arithmetic
  double bound = 0.0;              ///< an error above it is `degraded`
  /// The receivers stand in runs of so many along which visibility must not fall; 0: visibility may fall.
  std::size_t rising_run = 0;
};

/// A fall of more than this along a run that must rise makes a case broken.
inline constexpr double kLargestFall = 0.1;

/// Judges a result by its largest error. It is broken where texels of the map overflowed, where a visibility is NaN or
/// infinite, where all is lit or all is dark although it should not be, and where a run falls. It is degraded where the
/// error is over the bound.
Observation judge(const LookupResult& result, const Expected& expected);

/// The widest kernel that a straight edge has room for, in texels: half its map.
inline constexpr int kWidestRadius = 64;

/// Makes a map with a straight edge down its middle, left an occluder, right the receivers' own surface, and receivers
/// across the edge from dark to light, whose kernels of `radius_texels` and a bilinear reading lie within the map.
/// Requires 0 <= radius_texels <= kWidestRadius.
SyntheticScene make_straight_edge(double radius_texels);

/// What a kernel leaves lit of each receiver: every texel of it compared with the receiver's depth.
std::vector<double> compare_whole_kernel(const SyntheticScene& scene, const filters::Kernel& kernel);

/// Judges a filter on a straight edge against what it must be, within kVisibleError. Kinds other than stochastic must
/// rise from dark to light.
Observation judge_edge(const LookupResult& seen, std::vector<double> expected, filters::FilterKind kind);

/// The depths on both sides of an edge: an occluder, and the receivers' own.
struct EdgeDepths {
  float occluder = 0.0f;
  float receiver = 1.0f;
};

/// A map of horizontal bands, each split by an edge down the middle: left the occluder, right the receivers' surface.
/// Across each edge stand receivers, at the depth of their band's surface, whose kernel holds both depths and nothing
/// else.
struct EdgeScene {
  SyntheticScene scene;
  std::vector<double> lit_share;  ///< of each receiver's kernel: the weight of its own surface, in (0,1)
  std::vector<std::size_t> band;  ///< of each receiver
  std::size_t run = 0;            ///< receivers per band, from dark to light
};

/// Makes one for a Gaussian prefilter of `radius_texels` and a map read with the bilinear tent, at texel centres; with
/// radius 0 between them. The map has room for the kernel, and as many texels as the bands need, `least_size` or more.
EdgeScene make_edge_scene(int radius_texels, const std::vector<EdgeDepths>& bands, int least_size = 64);

/// Makes one for a filter that averages the map with `kernel` and blurs nothing before: receivers anywhere between
/// texels across each edge, in the middle of a row.
EdgeScene make_edge_scene(const filters::Kernel& kernel, const std::vector<EdgeDepths>& bands);

/// Gives other depths to the same edges.
void set_depths(EdgeScene& edge, const std::vector<EdgeDepths>& bands);

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

/// How an empty plane lies under the light.
struct PlaneTilt {
  double angle_deg = 0.0;  ///< between the light and the plane's normal, 0 <= angle < 90
  bool diagonal = false;   ///< the plane falls away along the texels' diagonal; otherwise along their rows
};

/// The side of the plane's map, in texels; it is a metre wide.
inline constexpr int kPlaneMapTexels = 64;
inline constexpr double kPlaneTexel_m = 1.0 / kPlaneMapTexels;

/// The depth in metres that the plane gains over a kernel which reaches so many texels on each axis, and which a
/// bias has to cover: s r tan(angle), and sqrt 2 times that on the diagonal.
double find_gain_m(const PlaneTilt& tilt, double reach_texels);

/// An empty plane without end, with receivers all over it, between texels too. Every shadow on it is acne.
class TiltedPlane {
 public:
  /// Requires inputs.renderer, which outlives the plane.
  TiltedPlane(const AxisInputs& inputs, filters::FilterRequest request)
      : seed_(inputs.seed), bench_(inputs, std::move(request)) {}

  /// Draws the plane's map. Throws Error as render::FilterPasses and render::ShadowMap.
  void tilt(const PlaneTilt& tilt);

  /// The mean shadow on the receivers, moved towards the light by a bias in metres. Call after tilt().
  double find_acne(double bias_m);

  /// Finds the least bias without acne, in metres, to a thousandth of `theory_m`; empty where twice that is not enough.
  /// Call after tilt().
  std::optional<double> find_needed_bias(double theory_m);

  /// The error in metres that single precision leaves in a depth.
  double rounding_m() const;

 private:
  std::uint32_t seed_;
  FilterBench bench_;
  PlaneTilt tilt_;
};

}  // namespace shadowbench::stress
