#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "harness/render/picture_passes.h"
#include "harness/view/layers.h"
#include "harness/view/look.h"
#include "harness/view/panels/widgets.h"

namespace shadowbench::view {

/// Shows the pixels around the pointer enlarged, for both sides, with the exact values of the one under it.
class Magnifier {
 public:
  Magnifier(Workbench& bench, render::DisplayPass& display, Widgets widgets)
      : bench_(bench), display_(display), widgets_(widgets) {}

  /// Lays out a window of its own; `shown` is what both sides show of the layer. `pixel` is the picture's under the
  /// pointer, row 0 on top; nothing: the pointer is elsewhere, and what was under it last is shown.
  void lay_out(Look& look, const Layer& layer, const std::array<ShownLayer, kSides>& shown,
               const std::optional<glm::ivec2>& pixel, const glm::vec2& corner, float scale);

  /// The value of a layer at a pixel, row 0 on top; of a picture its channels.
  static std::vector<float> read_value(const render::DisplayedValues& shown, const glm::ivec2& pixel);

 private:
  Workbench& bench_;
  render::DisplayPass& display_;
  Widgets widgets_;
  std::optional<render::ImageTarget> target_;
  glm::ivec2 last_pixel_{0};

  void show_pixels(const std::array<ShownLayer, kSides>& shown, int magnified);
  void show_values(const Layer& layer, const std::array<ShownLayer, kSides>& shown) const;
};

}  // namespace shadowbench::view
