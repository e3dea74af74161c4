#include "harness/scene/lights/light_ring.h"

#include <cassert>
#include <glm/gtx/rotate_vector.hpp>

namespace shadowbench::scene {

std::vector<Light> make_light_ring(const Light& first, int count) {
  assert(count >= 1);
  std::vector<Light> lights(static_cast<std::size_t>(count), first);
  for (int i = 1; i < count; ++i) {
    const double turn_rad = glm::radians(360.0 * i / count);
    lights[static_cast<std::size_t>(i)].direction_ws =
        glm::vec3(glm::rotateY(glm::dvec3(first.direction_ws), turn_rad));
  }
  return lights;
}

}  // namespace shadowbench::scene
