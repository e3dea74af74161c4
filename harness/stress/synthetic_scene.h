#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "filters/model.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/stress/case_tools.h"

namespace shadowbench::stress {

/// A depth map that is made of numbers, not drawn, and receivers that are looked up in it.
struct SyntheticScene {
  int size = 0;               ///< texels per side of the map
  std::vector<float> depths;  ///< size * size, row 0 at v = 0
  std::vector<glm::vec3>
      receivers;  ///< u, v, depth, each in [0,1] inside the map; they face the light, and no bias is applied
  /// For the GL alone: another way from receivers to u, v, depth. Of the scenes that one lookup sees, all are
  /// projective or none is.
  std::optional<scene::LightFrustum> frustum = {};

  /// The uv of a texel's centre.
  float uv(int texel) const { return (static_cast<float>(texel) + 0.5f) / static_cast<float>(size); }
};

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

/// The largest difference of two lists of one length.
double find_largest_error(const std::vector<double>& seen, const std::vector<double>& expected);

/// Judges that a visibility is NaN or infinite; nothing where all are finite.
std::optional<Observation> judge_not_finite(const std::vector<double>& visibility);

/// Judges a result by its largest error. It is broken where texels of the map overflowed, where a visibility is NaN or
/// infinite, where all is lit or all is dark although it should not be, and where a run falls. It is degraded where the
/// error is over the bound.
Observation judge(const LookupResult& result, const Expected& expected);

}  // namespace shadowbench::stress
