#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "filters/receiver.h"
#include "harness/render/picture_passes.h"
#include "harness/view/layers.h"
#include "harness/view/settings_panel.h"
#include "harness/view/view_state.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

/// What of the map a filter looks at for one receiver.
struct Footprint {
  filters::Receiver receiver;
  glm::dvec2 place_texels{0.0};    ///< of the receiver in its layer, from the map's first row and column
  double half_width_texels = 0.0;  ///< of the square that holds it; 0: a point
  bool is_disk = false;
};

/// Shows the depth map, or what a side's filter stores in its place, with the footprint of its kernel for the receiver
/// under the pointer.
class MapPanel {
 public:
  MapPanel(Workbench& bench, Layers& layers, render::DisplayPass& display, Widgets widgets)
      : bench_(bench), layers_(layers), display_(display), widgets_(widgets) {}

  /// Lays out a window of its own. `pixel` is the picture's under the pointer, row 0 on top, and `side` the side that
  /// is seen there; nothing: the pointer is elsewhere, and what was under it last is shown.
  void lay_out(Look& look, const std::optional<glm::ivec2>& pixel, std::size_t side, float scale);

  /// Shows this from the next time on, until the pointer is over the picture.
  void look_at(const MapReading& reading);

 private:
  Workbench& bench_;
  Layers& layers_;
  render::DisplayPass& display_;
  Widgets widgets_;
  std::optional<render::ImageTarget> target_;
  std::string content_ = "depth";  ///< as MapReading has it
  double zoom_ = 1.0;
  glm::vec2 last_place_{0.0f};  ///< in parts of the picture
  std::size_t last_side_ = 0;
  std::optional<Footprint> footprint_;

  /// The footprint of the last side's filter for the receiver that a pixel shows, row 0 on top; nothing where it shows
  /// none, where the map does not reach, and for the truth. Cost: milliseconds.
  std::optional<Footprint> find_footprint(const glm::ivec2& pixel);
  std::optional<filters::Receiver> find_receiver(const render::LightLayers& light, const glm::ivec2& pixel) const;
  std::vector<std::string> list_contents() const;
  images::Image read_content(int layer) const;
  void show_map(int side_pixels, int layer);
  void draw_footprint(const glm::vec2& corner, int side_pixels, const glm::dvec2& first_texel) const;
};

/// Times the passes of what is shown, only while nothing moves and nothing else works: such times compare.
class TimeMeter {
 public:
  explicit TimeMeter(Workbench& bench) : bench_(bench) {}

  /// Times each pass once, unless enough rounds were timed since the last drawing. Whether more rounds wait.
  bool step();

  /// Lays out the medians in the current ImGui window.
  void lay_out() const;

 private:
  Workbench& bench_;
  std::map<std::string, std::vector<double>> times_ms_;  ///< since the last drawing, by pass: "left lookup"
  std::uint64_t drawing_ = 0;
};

}  // namespace shadowbench::view
