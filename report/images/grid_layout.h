#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/images/grid.h"
#include "report/images/text.h"

namespace shadowbench::images {

/// What a text of a grid is.
enum class TextRole { kTitle, kSubtitle, kLabel, kCaption, kMessage, kLegend };

/// One line of text and the box it keeps to.
struct TextLine {
  Rect box;
  std::string text;
  TextRole role = TextRole::kCaption;
};

/// Which of a tile's images a panel shows.
enum class PanelKind { kPicture, kVisibility, kError, kPictureCrop, kVisibilityCrop };

/// The place of one image; `box` has the size it is shown at.
struct Panel {
  Rect box;
  std::size_t tile = 0;
  PanelKind kind = PanelKind::kPicture;
};

/// The place of a patch in a part's colour, beside its name.
struct Swatch {
  Rect box;
  std::size_t part = 0;
};

/// The place of everything in a grid; no two boxes overlap, and all lie in the canvas.
struct GridLayout {
  Size canvas;
  std::vector<TextLine> texts;
  std::vector<Panel> panels;
  std::optional<Rect> color_bar;      ///< there only if the grid shows errors
  double error_scale = 0.0;           ///< the error at the bar's right end
  std::vector<Rect> message_boxes;    ///< one per tile without images, around its message
  std::vector<BarPlace> bars;         ///< one per tile with an attribution
  std::optional<BarScale> bar_scale;  ///< there only if the grid shows bars
  std::vector<Swatch> swatches;       ///< the bars' legend
};

/// Returns the font of a kind of text.
Font font_of(TextRole role);

/// Returns the size at which an image of `size` is shown in a box: the largest that fits, a whole multiple of the image
/// where it is magnified.
Size fit_size(Size size, Size box);

/// Returns the grid's crop cut to an image's bounds.
Rect clip_crop(const Rect& crop, const Image& image);

/// Places everything in a grid.
/// Throws Error(kOutput) where the font is not installed.
GridLayout layout_grid(const Grid& grid);

}  // namespace shadowbench::images
