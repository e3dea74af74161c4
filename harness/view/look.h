#pragma once

#include <cstddef>
#include <glm/glm.hpp>

namespace shadowbench::view {

/// How the two sides share the picture.
enum class Sharing {
  kDivider,  ///< left and right of a line that can be dragged
  kFlip,     ///< all of one side; a key changes to the other
};

/// What the window shows beside the state: nothing of it changes an image.
struct Look {
  Sharing sharing = Sharing::kDivider;
  std::size_t flipped_to = 0;  ///< Sharing::kFlip: the side that is seen
  float divider = 0.5f;        ///< part of the picture's width
  std::size_t layer = 0;       ///< index into Layers::list()
  float error_scale = 0.2f;    ///< the error with the full colour
  bool panels = true;
  bool magnifier = false;
  bool map = false;
  bool help = false;
};

/// Where the picture lies in the window; pixels of the framebuffer from its upper left corner.
struct PicturePlace {
  glm::vec2 corner{0.0f};
  float magnified = 1.0f;  ///< the window's pixels for each of the picture's
  glm::ivec2 pixels{1};    ///< the picture's size

  glm::vec2 size() const { return magnified * glm::vec2(pixels); }

  /// The picture's place under one of the window, in pixels, rows top to bottom; may lie outside.
  glm::vec2 to_picture(const glm::vec2& place) const { return (place - corner) / magnified; }
  bool holds(const glm::vec2& place) const {
    const glm::vec2 at = to_picture(place);
    return at.x >= 0.0f && at.y >= 0.0f && at.x < static_cast<float>(pixels.x) && at.y < static_cast<float>(pixels.y);
  }

  /// The column at which the right side begins, in the picture's pixels.
  float divider_column(const Look& look) const {
    if (look.sharing == Sharing::kDivider) return look.divider * static_cast<float>(pixels.x);
    return look.flipped_to == 0 ? static_cast<float>(pixels.x) : 0.0f;
  }
};

}  // namespace shadowbench::view
