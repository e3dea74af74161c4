#pragma once

#include <optional>
#include <vector>

#include "report/images/canvas.h"
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

  /// Returns where a value lies: 0 is the left end, 1 the right end.
  double place(double value) const { return (value + below) / length; }
};

/// Chooses the scale of several bars: all of them fit, and the length is a round number, at least 0.001.
BarScale choose_bar_scale(const std::vector<AttributionBar>& bars);

/// Draws a bar: its parts side by side on a pale track, a grey line at zero behind them, and over them a black tick at
/// the RMSE; line and tick stand out above and below by 4 pixels. Requires more than 8 pixels of height.
Image draw_bar(const AttributionBar& bar, const BarScale& scale, Size size);

}  // namespace shadowbench::images
