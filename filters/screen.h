#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "filters/model.h"

namespace shadowbench::filters {

/// What lookups made of a picture, as the models of screen passes read it: shaders/lib/screen_input.glsl.
class ScreenPicture {
 public:
  struct Pixel {
    glm::vec3 position_ws{0.0f};
    glm::vec3 normal_ws{0.0f};  ///< geometric
    float share = 0.0f;         ///< of the receiver, in the layers of the map so far
    ModelResult result = {.visibility = 0.0};

    /// A filter was asked about all of it.
    bool takes_part() const { return share > 0.999f; }
  };

  /// Nothing where these values ask for no screen pass, or the model has none.
  static std::optional<ScreenPicture> make(const ScalarModel& model, const FilterSpec& spec, const ParamValues& values,
                                           int width, int height) {
    if (!model.screen || list_screens(spec, values).empty()) return std::nullopt;
    return ScreenPicture(width, height);
  }

  ScreenPicture(int width, int height)
      : size_(width, height), pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  /// Adds what a layer of the map makes of its share of a receiver.
  void add(const Receiver& receiver, const ModelResult& result);

  /// Null outside the picture, and where it takes no part.
  const Pixel* find(glm::ivec2 pixel) const {
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size_.x || pixel.y >= size_.y) return nullptr;
    const Pixel& found = pixels_[static_cast<std::size_t>(pixel.y * size_.x + pixel.x)];
    return found.takes_part() ? &found : nullptr;
  }

  /// Runs the screen passes that these values ask for. Requires a model that has them. Cost: all reads of every pixel.
  void filter(const ScalarModel& model, const FilterSpec& spec, const ParamValues& values, Precision precision);

  /// Calls `use` for what takes part, with its index where rows run from top to bottom.
  template <class Use>
  void visit_from_top(const Use& use) const {
    for (std::size_t i = 0, width = static_cast<std::size_t>(size_.x); i < pixels_.size(); ++i)
      if (pixels_[i].takes_part()) use(pixels_.size() - (i / width + 1) * width + i % width, pixels_[i].result);
  }

  const std::vector<Pixel>& pixels() const { return pixels_; }  ///< rows bottom to top

 private:
  glm::ivec2 size_;
  std::vector<Pixel> pixels_;
};

/// near_on_surface() of shaders/lib/screen_blur.glsl, of receivers or pixels; the radius in metres.
template <class T, class Surface>
T near_on_surface(const Surface& here, const Surface& there, const T& radius) {
  using P = Position<T>;
  const auto multiply = [](const glm::vec3& a, const glm::vec3& b) {
    const auto part = [](float x, float y) { return T(static_cast<P>(x)) * T(static_cast<P>(y)); };
    return part(a.x, b.x) + part(a.y, b.y) + part(a.z, b.z);
  };
  const glm::vec3 between = there.position_ws - here.position_ws;
  const T square = multiply(between, between), off_plane = multiply(here.normal_ws, between);
  const T one(P(1)), none(P(0)), turned = one - multiply(here.normal_ws, there.normal_ws);
  return maximum(one - square / (radius * radius), none) * maximum(one - T(P(8)) * turned, none) *
         maximum(one - T(P(16)) * off_plane * off_plane / maximum(square, T(P(1e-12))), none);
}

}  // namespace shadowbench::filters
