#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "report/analysis/measures.h"

namespace shadowbench::document {

/// An axis: its ends, its ticks, and whether steps are ratios.
struct ChartAxis {
  bool log = false;
  double low = 0.0;
  double high = 1.0;
  std::vector<std::pair<double, std::string>> ticks;  ///< ascending, within the ends
};

/// What the ticks stand for.
enum class TickKind { kNumber, kBytes };

/// Chooses an axis that holds all values with a margin: logarithmic where all are positive and span a factor of 3 or
/// more, otherwise linear, from 0 where the values reach near it. Ends that are not positive do not keep an axis from
/// being logarithmic where `ends` is what they are in: pass values as `values` and interval ends as `ends`.
ChartAxis choose_axis(const std::vector<double>& values, const std::vector<double>& ends, TickKind kind);

/// Does the same, but keeps to a logarithmic axis for positive values that lie close together too.
ChartAxis choose_log_axis(const std::vector<double>& values, const std::vector<double>& ends);

/// How a series' points are joined.
enum class LineStyle {
  kNone,
  kSteps,  ///< along x, then along y
  kSolid,
  kDashed,
  kTies  ///< dotted, from each point to the one after it, in pairs
};

/// The mark at a point.
enum class Mark { kNone, kCircle, kSquare, kTriangle, kDiamond, kTriangleDown };

/// The colour of lines that belong to no filter.
inline constexpr const char* kInk = "#1c1f24";

/// How a filter is drawn in charts.
struct ChartStyle {
  const char* color;  ///< "#rrggbb", on white
  Mark mark;
};

/// The style of the filter at a place in list_filters(): colours that people of every colour vision tell apart,
/// and marks that change with them, so that 35 filters have styles of their own. Source of the colours: Okabe and Ito
/// 2008, Color Universal Design; without their yellow, which is faint on white.
ChartStyle style_of(std::size_t filter);

/// A point with its intervals, and what is said of it.
struct ChartPoint {
  analysis::Estimate x;
  analysis::Estimate y;
  std::string label = {};                 ///< beside the point; empty: none
  std::vector<std::string> details = {};  ///< lines shown when one points at it
  std::string opens = {};                 ///< key of the cell that the viewer shows when one clicks it; empty: none
  std::string group = {};                 ///< the reader may choose one; empty: shown with every group
};

/// A point without intervals.
inline ChartPoint exact_point(double x, double y) { return {{x, x, x}, {y, y, y}}; }

/// Points drawn alike.
struct ChartSeries {
  std::string title;  ///< in the key; empty: not in the key, and shown and hidden with the titled series before it
  std::string color;  ///< "#rrggbb"
  Mark mark = Mark::kNone;
  bool filled = true;
  bool faint = false;
  LineStyle line = LineStyle::kNone;
  bool whiskers = false;
  std::vector<ChartPoint> points;
  bool hidden = false;  ///< until one clicks its name in the key
};

/// A solid line with a filter's colour and marks, without points.
inline ChartSeries make_line(std::string title, const ChartStyle& style) {
  return {.title = std::move(title), .color = style.color, .mark = style.mark, .line = LineStyle::kSolid, .points = {}};
}

/// One chart, drawn in the browser, where it can be saved as SVG and as PNG.
struct Chart {
  std::string id;  ///< unique on its page; names the file that is saved
  std::string title;
  std::string x_name;
  std::string y_name;
  ChartAxis x;
  ChartAxis y;
  std::vector<ChartSeries> series;
  std::vector<std::string> notes;  ///< below the key
};

/// So many curves are shown at first.
inline constexpr std::size_t kMostShown = 6;

/// Hides all but kMostShown of the curves that titles name, the ones that say most; a curve without title is hidden
/// with the titled one before it. Curves that no title names stay.
void show_most_telling(Chart& chart, std::vector<std::pair<double, std::string>> weights_and_titles);

/// Charts of which the reader chooses one; without selectors all are shown, small, beside each other, with one key.
struct ChartChoice {
  struct Selector {
    std::string label;
    std::vector<std::string> options;
    std::vector<std::string> costs = {};  ///< ids of the options: the one that the page's reader chose is taken
  };
  std::string id;
  std::vector<Selector> selectors;
  std::vector<Chart> charts;  ///< in row-major order of the selectors' options: the last selector changes fastest
};

}  // namespace shadowbench::document
