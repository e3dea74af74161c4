#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/images/canvas.h"
#include "report/images/text.h"

namespace shadowbench::images {

/// How wide a picture is in a figure of 1500 pixels and three columns.
inline constexpr int kColumnWidth = 468;

inline constexpr Rgb kInk{0.11f, 0.12f, 0.14f}, kSecondInk{0.33f, 0.35f, 0.39f}, kWarningInk{0.70f, 0.15f, 0.05f};
inline constexpr Rgb kFrame{0.68f, 0.70f, 0.73f};

/// A place on a picture's edge, and what stands below it.
struct Tick {
  double place = 0.0;  ///< from the picture's left end, 0, to the other, 1
  std::string label;
};

/// A cell of a figure: from top to bottom a title, words, a warning and a picture, each only where there is one.
struct Cell {
  std::string title = {};
  std::string words = {};
  Image picture = {};            ///< display values, 3 channels; shown pixel by pixel
  std::vector<Tick> below = {};  ///< along the picture's lower edge, from left to right
  std::string warning = {};
};

/// Cells that stand below one another.
using Stack = std::vector<Cell>;

/// A table of cells, for people.
struct Figure {
  std::string title = {};
  std::string note = {};
  std::vector<Stack> stacks = {};  ///< side by side; cells of one number line up
  int columns = 6;                 ///< stacks side by side; the rest follows below
  Stack legend = {};               ///< below all of them, over the whole width
};

/// The width of sheets: PNG files for screens, or SVG files with text of 8 points for papers.
struct SheetWidth {
  double value = 1920.0;
  bool in_inches = false;  ///< else pixels

  bool operator==(const SheetWidth&) const = default;
};

/// Where one line of text stands.
struct PlacedText {
  Rect box;
  std::string text;
  Font font;
  Rgb ink;
};

/// Where an image is shown, scaled to its box.
struct PlacedPicture {
  Rect box;
  const Image* picture = nullptr;  ///< display values, 3 channels
  Rgb frame = kFrame;
  int frame_width = 1;  ///< around the box
};

/// A filled rectangle.
struct PlacedRect {
  Rect box;
  Rgb ink;
};

/// The place of everything on a canvas, which lies in it: drawn in the order of pictures, marks, texts.
struct Layout {
  Size canvas;
  std::vector<PlacedText> texts;
  std::vector<PlacedPicture> pictures;
  std::vector<PlacedRect> marks;
};

/// Places everything in a figure, which the result points into; no two boxes overlap. Words are wrapped to their
/// column; a tick whose label has no room beside the one before has none. Throws Error(kOutput) where the font is not
/// installed.
Layout layout_figure(const Figure& figure);

/// Draws rows of a canvas: display values, 3 channels. Throws Error(kOutput) where the font is not installed.
Image draw_rows(const Layout& layout, int top, int rows);

/// Draws a canvas into an 8-bit PNG file, a band of it at a time. Throws Error(kOutput).
void write_layout(const std::filesystem::path& path, const Layout& layout);

/// Draws a figure into an 8-bit PNG file. Throws Error(kOutput).
void write_figure(const std::filesystem::path& path, const Figure& figure);

}  // namespace shadowbench::images
