#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace shadowbench::scene {

/// What a model's file says of the scene as a whole, where it does.
struct SceneExtras {
  std::optional<std::string> title;
  std::optional<glm::vec3> background;  ///< linear
};

}  // namespace shadowbench::scene
