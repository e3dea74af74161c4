#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/images/image.h"
#include "report/images/text.h"

namespace shadowbench::images {

/// What a figure is printed in; display values.
inline constexpr Rgb kFigureInk{0.11f, 0.12f, 0.14f};
inline constexpr Rgb kFigureSecondInk{0.33f, 0.35f, 0.39f};
inline constexpr Rgb kFigureLines{0.72f, 0.74f, 0.77f};

/// A white canvas with a title and notes above a free body.
class Figure {
 public:
  static constexpr int kMargin = 24;

  /// `body` is the size of what is drawn below the title.
  /// Throws Error(kOutput) where the font is not installed.
  Figure(const std::string& title, const std::string& note, Size body);

  const Rect& body() const { return body_; }

  /// Fills what of a rectangle lies on the canvas.
  void fill(const Rect& rect, const Rgb& color);

  /// Copies a picture of 3 channels, display values, its left top corner at (x, y).
  void place(int x, int y, const Image& picture);

  /// Writes a line of text that begins at `x`, is centred on it, or ends there.
  void write(int x, int top, const std::string& text, Rgb color = kFigureSecondInk);
  void write_centred(int x, int top, const std::string& text, Rgb color = kFigureSecondInk);
  void write_before(int x, int top, const std::string& text, Rgb color = kFigureSecondInk);

  const Image& canvas() const { return canvas_; }

 private:
  Image canvas_;
  Rect body_;
};

/// Splits a text into lines that Figure::write draws no wider than `width` pixels.
std::vector<std::string> wrap_figure_text(const std::string& text, int width);

/// The height of a line that Figure::write writes.
int figure_line_height();

}  // namespace shadowbench::images
