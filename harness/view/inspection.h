#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/model.h"
#include "filters/receiver.h"
#include "harness/render/picture_passes.h"
#include "harness/view/layers.h"
#include "harness/view/settings_panel.h"
#include "harness/view/view_state.h"
#include "harness/view/workbench.h"

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

/// What of the map a filter looks at for one receiver.
struct Footprint {
  filters::Receiver receiver;
  glm::dvec2 place_texels{0.0};    ///< of the receiver in its layer, from the map's first row and column
  double half_width_texels = 0.0;  ///< of the square that holds it; 0: a point
  bool is_disk = false;
  std::vector<glm::ivec2> reads;  ///< texels of the depth map that the lookup reads, each once; empty where it reads
                                  ///< maps that were made of it, or where only its GLSL knows
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
  /// A filter's model over a layer of the map.
  struct Prepared {
    filters::FilterRequest request;
    filters::DepthMap map;
    std::unique_ptr<filters::Lookup> lookup;
  };

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
  std::uint64_t drawing_ = 0;                                     ///< that the models are of
  std::vector<std::vector<std::unique_ptr<Prepared>>> prepared_;  ///< by side and layer

  /// The footprint of the last side's filter for the receiver that a pixel shows, row 0 on top; nothing where it shows
  /// none, where the map does not reach, and for the truth. Cost: milliseconds; once a drawing, the map read back.
  std::optional<Footprint> find_footprint(const glm::ivec2& pixel);
  std::optional<filters::Receiver> find_receiver(const render::LightLayers& light, const glm::ivec2& pixel) const;
  Prepared* prepare(int layer);
  void add_reads(Footprint& footprint);
  std::vector<std::string> list_contents() const;
  images::Image read_content(int layer) const;
  void show_map(int side_pixels, int layer);
  void draw_footprint(const glm::vec2& corner, int side_pixels, const glm::dvec2& first_texel) const;
};

/// Times the passes of what is shown as a run does: one by one, each closed, a lookup four lookups after its prefilter.
/// It runs one pass a frame, and only while nothing moves and nothing else works: such times compare.
class TimeMeter {
 public:
  explicit TimeMeter(Workbench& bench) : bench_(bench) {}

  /// Runs the next pass, unless enough rounds have been timed since the last drawing. Whether more passes wait.
  bool step();

  /// Times since the last drawing, milliseconds, the oldest first, by pass: "left lookup". A filter alone is its lookup
  /// minus an empty one of the same round.
  const std::map<std::string, std::vector<float>>& histories() const { return histories_; }

 private:
  Workbench& bench_;
  std::map<std::string, std::vector<float>> histories_;
  std::vector<std::function<void()>> round_;  ///< passes of the round that are still to be run, the last one first
  std::uint64_t drawing_ = 0;
  std::size_t rounds_ = 0;

  void plan_round();
  void plan_side(std::size_t side);
  float time(const std::function<void()>& work) const;
};

/// Lays out the times of both sides, with their history, in the current ImGui window.
void show_times(const Workbench& bench, const TimeMeter& meter);

}  // namespace shadowbench::view
