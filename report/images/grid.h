#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/images/attribution_bar.h"
#include "report/images/figure.h"
#include "report/images/hardest_edge.h"

namespace shadowbench::images {

/// One filter's place in a grid.
struct GridTile {
  std::string label;    ///< "vsm"
  std::string caption;  ///< "radius 4, rg32f · 12.3 ms (CPU)"; wrapped where it is long
  Image picture;        ///< linear RGB; empty where the cell has none
  Image visibility;     ///< 1 channel, the picture's size; empty where the cell has none
  Image error;          ///< 1 channel, signed: visibility less truth; empty where there is no truth
  std::string message;  ///< shown instead of the images where all are empty: "timed out after 10 s"
  std::optional<AttributionBar> attribution = std::nullopt;  ///< the parts of the error, drawn as a bar
  std::string attribution_words = {};  ///< the same in words, or why there is no bar; said where some tile has one
};

/// A labelled picture of what filters make of one scene, for people.
struct Grid {
  std::string title;
  std::string subtitle;
  std::vector<GridTile> tiles;
  Rect crop;              ///< pixels of the pictures, outlined there and magnified below; may be empty
  int columns = 3;        ///< tiles side by side
  double exposure = 1.0;  ///< linear factor, the same for all tiles
  Image mask = {};        ///< 1 channel, 0 where no receiver is: visibility is hatched there; may be empty
  std::optional<double> error_scale = std::nullopt;  ///< the error that gets the full colour; chosen where not given
};

/// The cells of a tile's stack, in their order; those that a tile lacks are empty.
enum GridCell : std::size_t { kPictureCell, kVisibilityCell, kErrorCell, kBarCell, kCropCell };

/// Makes the figure of a grid: of each tile its label, a caption, the picture, the visibility, the error as a heat map,
/// the bar of its parts, and the crop of picture and, to the right of it, visibility, magnified to whole texels. All
/// heat maps share one scale, and all bars one, which the legend says. Large pictures are reduced in linear light. A
/// texel that is not finite becomes magenta.
Figure make_figure(const Grid& grid);

/// Draws a grid into an 8-bit PNG file.
/// Throws Error(kOutput).
void write_grid(const std::filesystem::path& path, const Grid& grid);

}  // namespace shadowbench::images
