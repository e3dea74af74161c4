#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/model.h"
#include "filters/receiver.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

/// What of the map a filter looks at for one receiver.
struct Footprint {
  filters::Receiver receiver;
  glm::dvec2 place_texels{0.0};    ///< of the receiver in its layer, from the map's first row and column
  std::string shape;               ///< of the kernel, in words
  double half_width_texels = 0.0;  ///< of the square that holds it; 0: a point
  bool is_disk = false;
  std::vector<glm::ivec2> reads;  ///< texels of the depth map that the lookup reads, each once; empty where it reads
                                  ///< maps that were made of it, or where only its GLSL knows
};

/// Finds footprints, and keeps what that needs until the next drawing.
class FootprintFinder {
 public:
  explicit FootprintFinder(Workbench& bench) : bench_(bench) {}

  /// The footprint of a side's filter for the receiver that a pixel shows, row 0 on top; nothing where it shows none,
  /// where the map does not reach, and for the truth. Cost: milliseconds; once a drawing, the map read back.
  std::optional<Footprint> find(std::size_t side, const glm::ivec2& pixel);

 private:
  /// A filter's model over a layer of the map.
  struct Prepared {
    filters::FilterRequest request;
    filters::DepthMap map;
    std::unique_ptr<filters::Model> model;
    std::unique_ptr<filters::Lookup> lookup;
  };

  Workbench& bench_;
  std::uint64_t drawing_ = 0;
  std::vector<std::vector<std::unique_ptr<Prepared>>> prepared_;  ///< by side and layer

  std::optional<filters::Receiver> find_receiver(const render::LightLayers& light, const glm::ivec2& pixel) const;
  Prepared* prepare(std::size_t side, int layer);
  void add_reads(Footprint& footprint, std::size_t side);
};

}  // namespace shadowbench::view
