#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/model.h"
#include "harness/render/filter_passes.h"
#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// A depth map that nobody drew, and receivers that look into it.
struct ProbeScene {
  int size = 0;               ///< texels per side of the map
  std::vector<float> depths;  ///< size * size, row 0 at v = 0
  std::vector<glm::vec3>
      receivers;  ///< u, v, depth, each in [0,1] inside the map; they face the light, and no bias is applied
  /// For the GL alone: another way from receivers to u, v, depth; all that one probe sees are projective, or none.
  std::optional<scene::LightFrustum> frustum = {};

  /// Gives the uv of a texel's centre.
  float uv(int texel) const { return (static_cast<float>(texel) + 0.5f) / static_cast<float>(size); }
};

/// What a filter makes of a probe scene.
struct ProbeResult {
  std::vector<double> visibility;  ///< of the receivers, in their order
  std::int64_t broken_texels = 0;  ///< of the encoded map: overflown; 0 for models, which keep their map
};

/// A filter that looks into probe scenes, compiled once.
class Probe {
 public:
  virtual ~Probe() = default;
  /// Takes numeric parameters that are not const; texts, such as the store, stay those of the construction.
  virtual ProbeResult look(const ProbeScene& scene, const filters::ParamValues& values) = 0;
};

/// Looks through the passes of harness/render: encode, blur, lookup. Depths are stored as `map` says.
/// Requires context.renderer, which outlives the probe. Nothing is compiled or allocated before the first look, which
/// throws Error as render::FilterPasses and render::ShadowMap.
std::unique_ptr<Probe> make_gl_probe(const StressContext& context, const filters::FilterRequest& request,
                                     const render::MapSettings& map = {});

/// Looks through the filter's scalar model. Requires a filter that has one.
std::unique_ptr<Probe> make_model_probe(const StressContext& context, const filters::FilterRequest& request,
                                        filters::Precision precision = filters::Precision::kFloat);

/// Makes the probe of a level, for a case; null, with `reason`, where there is none: no GL, no model.
struct ProbeChoice {
  std::shared_ptr<Probe> probe;
  std::string reason;
};
ProbeChoice make_probe(const StressContext& context, const filters::FilterRequest& request, Level level);

/// What to hold an observation against.
struct Expected {
  std::vector<double> visibility;  ///< of the receivers, in exact arithmetic
  double bound = 0.0;              ///< `degraded` above this error
  /// The receivers stand in runs of this many along which visibility must not fall; 0: no such rule.
  std::size_t rising_run = 0;
};

/// Falls of more than this along a run that must rise make a case broken.
inline constexpr double kLargestFall = 0.1;

/// Judges a result, measured by its largest error: broken where texels of the map overflowed or a visibility is NaN or
/// infinite, where all is lit or all is dark although it should not be, or where a run falls; degraded where the error
/// is over the bound.
Observation judge(const ProbeResult& result, const Expected& expected);

}  // namespace shadowbench::stress
