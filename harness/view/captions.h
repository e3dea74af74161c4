#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>

#include "harness/view/layers.h"
#include "harness/view/view_state.h"
#include "report/images/color_values.h"
#include "report/images/image.h"

namespace shadowbench::view {

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

  /// Draws it into a picture, at the left; returns where the next may stand.
  int draw(images::Image& picture, int top) const;
};

/// Writes the captions of both sides into a picture, side by side where there is room; an empty one is left out.
/// Returns where more may stand below.
int draw_captions(images::Image& picture, const std::array<std::string, kSides>& texts);

}  // namespace shadowbench::view
