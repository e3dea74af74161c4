#pragma once

#include <vector>

#include "report/images/image.h"

namespace shadowbench::images {

/// Returns the size of a crop that can be magnified well, for pictures of this size.
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
