#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/images/image.h"
#include "report/records/error_parts.h"

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

/// Names the parts that matter most to a bar, two at most, largest magnitude first, none below 1 %:
/// "estimator 71 %, model 20 %". Empty where the RMSE is 0.
std::string label_bar(const AttributionBar& bar);

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

  /// Returns where a value lies: 0 is the left end, 1 the right end.
  double place(double value) const { return (value + below) / length; }
};

/// Chooses the scale of several bars: all of them fit, and the length is a round number, at least 0.001.
BarScale choose_bar_scale(const std::vector<AttributionBar>& bars);

/// The place of one part of a bar, in pixels.
struct SegmentBox {
  Rect box;
  std::size_t part = 0;
};

/// The place of a bar in a picture, in pixels.
struct BarPlace {
  Rect box;                          ///< of all of it
  Rect track;                        ///< what the scale spans
  Rect zero_line;                    ///< as high as `box`
  Rect net_tick;                     ///< as high as `box`, at the RMSE
  std::size_t tile = 0;              ///< whose bar it is
  std::vector<SegmentBox> segments;  ///< inside the track, side by side; each edge on the pixel nearest to its value
};

/// Places a bar in a box. Requires room for the overhang of its lines, 9 pixels of height.
BarPlace place_bar(const AttributionBar& bar, const BarScale& scale, const Rect& box, std::size_t tile);

}  // namespace shadowbench::images
