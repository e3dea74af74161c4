#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "harness/render/display_pass.h"
#include "harness/view/footprint.h"
#include "harness/view/layers.h"
#include "harness/view/look.h"
#include "harness/view/panels/widgets.h"

namespace shadowbench::view {

/// Shows the depth map, or what a side's filter stores in its place, with the footprint of its kernel for the receiver
/// under the pointer.
class MapPanel {
 public:
  MapPanel(Workbench& bench, Layers& layers, render::DisplayPass& display, Widgets widgets)
      : bench_(bench), layers_(layers), display_(display), widgets_(widgets), footprints_(bench) {}

  /// Lays out a window of its own. `pixel` is the picture's under the pointer, row 0 on top, and `side` the side that
  /// is seen there; nothing: the pointer is elsewhere, and what was under it last is shown.
  void lay_out(Look& look, const std::optional<glm::ivec2>& pixel, std::size_t side, float scale);

 private:
  Workbench& bench_;
  Layers& layers_;
  render::DisplayPass& display_;
  Widgets widgets_;
  FootprintFinder footprints_;
  std::optional<render::ImageTarget> target_;
  std::size_t content_ = 0;  ///< 0: depth; else a channel of the stored map, from 1 on
  double zoom_ = 1.0;
  glm::ivec2 last_pixel_{0};
  std::size_t last_side_ = 0;
  std::optional<Footprint> footprint_;

  images::Image read_content(int layer) const;
  void show_map(int side_pixels, int layer);
  void draw_footprint(const glm::vec2& corner, int side_pixels, const glm::dvec2& first_texel) const;
};

}  // namespace shadowbench::view
