#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "reference/truth/visibility.h"
#include "report/images/image.h"

namespace shadowbench::engines {

/// A shadow map of another renderer.
struct OwnMap {
  images::Image depth;             ///< one channel, as it is stored; the first row is v = 1
  glm::dmat4 map_from_world{1.0};  ///< to (u, v, depth, 1) times w; in the map u and v are 0 .. 1
};

/// Looks every receiver that counts up in the texel that it falls into, with the least bias that keeps planes free of
/// acne: half a texel's change of depth along the receiver's plane, along u and along v. 1 lit, 0 in shadow; beyond the
/// map all is lit. Whether depth grows away from the light is found from the matrix: `to_light_ws` leads to it.
/// What differs from a ray to the light's centre is then the map's doing: its texels, its precision, and what was drawn
/// into it.
std::vector<double> look_up(const OwnMap& map, const truth::ReceiverImage& receivers,
                            const std::vector<glm::vec3>& to_light_ws);

}  // namespace shadowbench::engines
