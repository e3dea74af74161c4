#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/images/figure.h"
#include "report/images/image.h"
#include "report/records/format.h"

namespace shadowbench::images {

/// A filter's error as a stacked bar: for each part its share of the RMSE, signed, in visibility.
/// The lengths sum to the RMSE.
struct AttributionBar {
  records::PartValues lengths{};  ///< 0 for a part that does not exist

  double net() const;  ///< the RMSE
};

/// Makes a cell's bar, share times RMSE; nothing where the cell has no RMSE or no attribution, or is suspect: it must
/// not set the scale of the others.
std::optional<AttributionBar> make_attribution_bar(const records::CellRecord& cell);

/// One part's stretch of a bar, in visibility from the zero line; begin < end.
struct BarSegment {
  std::size_t part = 0;
  double begin = 0.0;
  double end = 0.0;
};

/// Stacks a bar's parts in their order: positive ones from the zero line to the right, negative ones to the left.
std::vector<BarSegment> stack_segments(const AttributionBar& bar);

/// What bars are drawn on, in visibility: several bars share one, so that their lengths compare.
struct BarScale {
  double below = 0.0;   ///< from the left end to the zero line
  double length = 0.0;  ///< from the left end to the right end; positive
};

/// Chooses the scale of several bars: all of them fit, and the length is a round number, at least 0.001.
BarScale choose_bar_scale(const std::vector<AttributionBar>& bars);

/// One filter's place in a grid.
struct GridTile {
  std::string label;    ///< "vsm"
  std::string caption;  ///< "radius 4, rg32f · 12.3 ms (CPU)"; wrapped where it is long
  Image picture;        ///< linear RGB; empty where the cell has none
  Image visibility;     ///< 1 channel, the picture's size; empty where the cell has none
  Image error;          ///< 1 channel, signed: visibility less truth; empty where there is no truth
  std::string message;  ///< shown instead of the images where all are empty: "timed out after 10 s"
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
};

/// The cells of a tile's stack, in their order; those that a tile lacks are empty.
enum GridCell : std::size_t { kPictureCell, kVisibilityCell, kErrorCell, kCropCell };

/// Makes the figure of a grid: of each tile its label, a caption, the picture, the visibility, the error as a heat map,
/// and the crop of picture and, to the right of it, visibility, magnified to whole texels. All heat maps share one
/// scale, which the legend says. Large pictures are reduced in linear light. A
/// texel that is not finite becomes magenta.
Figure make_figure(const Grid& grid);

/// Draws a grid into an 8-bit PNG file.
/// Throws Error(kOutput).
void write_grid(const std::filesystem::path& path, const Grid& grid);

/// Returns the size of crop that a grid magnifies well for pictures of this size.
Size choose_crop_size(Size picture);

/// Finds the rectangle in which filters disagree most about a shadow's edge.
///
/// The score of a rectangle is the mean over its pixels of the variance of visibility across the filters, times
/// 4 m (1 - m), m the mean visibility of the reference in it: 1 where the reference is half lit and half blocked, 0
/// where it has no edge. Where no filter disagrees, the rectangle that the edge divides most evenly is taken; where
/// there is no edge, the one in which filters disagree most. Ties go
/// to the topmost, then leftmost rectangle; a pixel that is not finite in some image counts as one
/// on which filters agree, and where the reference is not finite as blocked.
///
/// `visibility`: 1 channel each, of one size; null or empty images are left out. `reference` is an index into it.
/// Returns a rectangle of `size`, clipped to the images; an empty one where there are no images.
Rect find_hardest_edge(const std::vector<const Image*>& visibility, std::size_t reference, Size size);

/// Finds the square, a sixteenth of the picture wide, with the largest mean. Values that are not finite count as 0;
/// ties go to the topmost, then leftmost one. `values`: 1 channel.
Rect find_hardest_tile(const Image& values);

}  // namespace shadowbench::images
