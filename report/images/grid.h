#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/images/figure.h"
#include "report/images/image.h"
#include "report/records/format.h"

namespace shadowbench::images {

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
Rect find_disputed_edge(const std::vector<const Image*>& visibility, std::size_t reference, Size size);

/// Finds the square, a sixteenth of the picture wide, with the largest mean. Values that are not finite count as 0;
/// ties go to the topmost, then leftmost one. `values`: 1 channel.
Rect find_largest_tile(const Image& values);

}  // namespace shadowbench::images
