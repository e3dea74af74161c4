#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/render/picture_passes.h"
#include "harness/view/view_state.h"
#include "harness/view/workbench.h"
#include "report/images/color_values.h"
#include "report/images/image.h"

namespace shadowbench::view {

/// What one side shows of a layer.
struct ShownLayer {
  render::DisplayedValues values;  ///< of the picture where the layer is absent
  std::string absent;              ///< why there is no layer; empty where there is
};

class Layers;

/// Something that can be seen of every pixel.
struct Layer {
  std::string id;
  std::string title;
  std::string unit;  ///< of the values; empty: none, or a picture
  std::string text;  ///< what it shows, one sentence
  ShownLayer (*show)(Layers& layers, const Layer& layer, std::size_t side) = nullptr;
};

/// The layers of both sides, and the textures that hold those that come from elsewhere than the passes.
class Layers {
 public:
  explicit Layers(Workbench& bench) : bench_(bench) {}

  /// All there are; one row of one table each.
  static const std::vector<Layer>& list();

  /// `scale` is the error that gets the full colour; only these columns will be looked at.
  ShownLayer show(const Layer& layer, std::size_t side, float scale, const glm::ivec2& columns);

  // For the rows of the table.
  Workbench& bench() { return bench_; }
  float scale() const { return scale_; }
  const glm::ivec2& columns() const { return columns_; }

  /// An image, rows top to bottom, in the colours of its range from the least finite value, or 0, to the greatest; kept
  /// until `version` is another.
  render::DisplayedValues upload(const std::string& id, std::uint64_t version,
                                 const std::function<images::Image()>& make_image);

 private:
  struct Kept {
    std::uint64_t version = 0;
    std::optional<gl::Texture> texture;
    float low = 0.0f, high = 1.0f;
    std::size_t infinite = 0;
  };

  Workbench& bench_;
  float scale_ = 0.2f;
  glm::ivec2 columns_{0};
  std::map<std::string, Kept> kept_;
};

/// The size of a text in the window, in lines of at most `room` pixels; 0: of one line.
glm::vec2 text_size(const std::string& text, float room = 0.0f);

/// Draws a text on a dark ground of this size behind the panels; that of what is hidden in grey.
void draw_caption(const glm::vec2& corner, const std::string& text, const glm::vec2& size, bool is_hidden = false);

/// What a layer's colours mean: its name, and the colours between what their ends stand for.
struct ScaleCaption {
  std::string low, high;
  images::Colors color;

  ScaleCaption(const Layer& layer, const render::DisplayedValues& values);

  bool operator==(const ScaleCaption& other) const { return low == other.low && high == other.high; }

  /// Draws it from its upper left corner on; returns its size.
  glm::vec2 draw(const glm::vec2& corner) const;
};

}  // namespace shadowbench::view
