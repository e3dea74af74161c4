#pragma once

#include <functional>

#include "reference/truth/visibility.h"

namespace shadowbench::truth {

/// The rays of one receiver: origin and direction are affine in a sample's offset, but for those to a sphere.
struct RayFan {
  glm::vec3 origin{0.0f};
  glm::vec3 origin_x{0.0f};
  glm::vec3 origin_y{0.0f};
  glm::vec3 direction{0.0f};
  glm::vec3 direction_x{0.0f};
  glm::vec3 direction_y{0.0f};
  glm::vec3 normal{0.0f};       ///< rays below this plane are blocked
  glm::vec3 light_axis{0.0f};   ///< of a flat light, unit length: its rays are weighed by what they would bring
  bool weighs = false;          ///< rays are weighed; without an axis they are evenly spread over solid angle
  float reach = 0.0f;           ///< in units of a direction's length
  float cap = 0.0f;             ///< above 0: rays to a sphere, which fills a cone; 1 - cos of half its angle, below 1
  float scale = 0.0f;           ///< of the second samples, which are added to the first ones
  bool origin_moves = true;     ///< false: origin_x and origin_y are 0
  bool direction_moves = true;  ///< false: direction_x and direction_y are 0
};

/// Makes the fan of one receiver, an index into ReceiverImage::points.
using MakeFan = std::function<RayFan(std::size_t)>;

/// Traces every receiver's fan over the same sample sets; see trace_area() for when a pixel stops. Fans with a scale
/// need `scaled`, second samples of as many points.
TracedVisibility trace_fans(const Occluders& occluders, const ReceiverImage& receivers, const SampleSets& samples,
                            const TraceSettings& settings, const MakeFan& make_fan, const SampleSets* scaled = nullptr);

}  // namespace shadowbench::truth
