#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace shadowbench::truth {

/// A receiver point of the G-buffer.
struct ReceiverPoint {
  glm::vec3 position_ws{0.0f};
  glm::vec3 normal_ws{0.0f, 1.0f, 0.0f};  ///< geometric, unit length, flipped to the viewer
  bool counts = false;                    ///< false: background, or turned away from the light; not traced
};

/// Receivers as an image, row by row.
struct ReceiverImage {
  int width = 0;
  int height = 0;
  std::vector<ReceiverPoint> points;  ///< width * height
  std::string content = {};           ///< a name for these points, by which a cache knows them; may be empty
};

}  // namespace shadowbench::truth
