#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace shadowbench::filters {

/// A surface faces the light where n.l is greater than this; the sign of smaller values is a matter of rounding.
/// shaders/lib/receiver.glsl has the same number.
inline constexpr float kFacesLight = 1e-5f;

/// A receiver point, as a filter sees it; the same fields, in the same order, as `Receiver` in
/// shaders/lib/receiver.glsl.
struct Receiver {
  glm::vec3 position_ws{0.0f};
  glm::vec3 normal_ws{0.0f, 1.0f, 0.0f};  ///< geometric, flipped to the viewer
  float n_dot_l = 1.0f;                   ///< of the geometric normal; filters are asked only where it is positive
  glm::vec2 uv{0.5f};                     ///< where in the map, [0,1]; outside is lit
  int layer = 0;                          ///< of the light's map: a cascade, a face of a cube; 0 where there is one
  float depth = 0.0f;                     ///< [0,1], 0 near, with the run's bias applied
  float depth_unbiased = 0.0f;            ///< [0,1]
  glm::vec2 depth_per_texel{0.0f};        ///< slope of the receiver's plane, per texel in u and in v
  glm::vec2 bias_per_texel{0.0f};         ///< what the run's bias takes off depth per texel of reach in u and in v
  float texel_size_ws = 1.0f;             ///< metres; under a lamp it grows with the distance
  float depth_range_ws = 1.0f;            ///< metres between depth 0 and depth 1
  float light_size = 0.0f;      ///< penumbra width per metre of distance to an occluder that is near the receiver
  float light_nearness = 0.0f;  ///< 1 / metres to the light, along its axis; 0 for a light at infinity
  float view_depth = 0.0f;      ///< metres from the camera, along its axis
  glm::ivec2 pixel{0};          ///< (0,0) is the lower left pixel
  std::uint32_t frame = 0;      ///< of the frames that are accumulated; turns its taps
  float layer_share = 1.0f;     ///< of the pixel's visibility that comes from this layer; not told to filters
};

}  // namespace shadowbench::filters
