#include "report/depth_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "report/figure.h"
#include "report/picture_io.h"
#include "report/summary.h"

namespace shadowbench::report {
namespace {

constexpr int kMapSide = 768;
constexpr int kPlotHeight = 220;
constexpr int kAxisWidth = 90;  // for the counts' labels
constexpr int kBinWidth = 4;
constexpr Rgb kEmpty{0.80f, 0.87f, 0.95f};
constexpr Rgb kBars{0.20f, 0.36f, 0.60f};

struct Range {
  float nearest = 1.0f;
  float farthest = 0.0f;
};

Range find_range(const Image& depth) {
  Range range;
  for (const float d : depth.texels) {
    if (!(d < 1.0f)) continue;
    range.nearest = std::min(range.nearest, d);
    range.farthest = std::max(range.farthest, d);
  }
  return range.nearest < range.farthest ? range : Range{0.0f, 1.0f};
}

/// Shows the map's texels as squares where it is small, and one of many where it is large.
Image draw_map(const Image& depth, const Range& range) {
  const int side = depth.width >= kMapSide ? kMapSide : depth.width * (kMapSide / depth.width);
  Image map(side, side, 3);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto texel = [&](int at) { return static_cast<int>(static_cast<std::int64_t>(at) * depth.width / side); };
      const float d = *depth.at(texel(x), texel(y));
      const float grey = 0.9f * (d - range.nearest) / (range.farthest - range.nearest);
      const Rgb color = d < 1.0f ? Rgb{grey, grey, grey} : kEmpty;
      std::copy(color.begin(), color.end(), map.at(x, y));
    }
  }
  return map;
}

/// Decades of the axis: the highest count lies on it.
int count_decades(const DepthHistogram& histogram) {
  const auto most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  return std::max(1, static_cast<int>(std::ceil(std::log10(static_cast<double>(std::max<std::int64_t>(most, 1))))));
}

void draw_count_axis(Figure& figure, const Rect& plot, int decades) {
  for (int decade = 0; decade <= decades; ++decade) {
    const int y = plot.y + plot.height - decade * plot.height / decades;
    figure.fill({plot.x, y, plot.width, 1}, kFigureLines);
    figure.write_before(plot.x - 8, y - figure_line_height() / 2, fmt::format("{}", static_cast<std::int64_t>(std::pow(10.0, decade))));
  }
}

void draw_depth_axis(Figure& figure, const Rect& plot, double range_m) {
  const int top = plot.y + plot.height + 8;
  for (const double depth : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const int x = plot.x + static_cast<int>(depth * plot.width);
    figure.fill({x, plot.y + plot.height, 1, 6}, kFigureSecondInk);
    figure.write_centred(x, top, format_number(depth));
    figure.write_centred(x, top + figure_line_height(), format_number(depth * range_m) + " m");
  }
}

void draw_histogram(Figure& figure, const Rect& plot, const DepthHistogram& histogram, double range_m) {
  const int decades = count_decades(histogram);
  draw_count_axis(figure, plot, decades);
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    // One texel still shows: it stands on the axis two pixels high.
    const int height = 2 + static_cast<int>(std::log10(static_cast<double>(histogram.counts[i])) / decades * (plot.height - 2));
    figure.fill({plot.x + static_cast<int>(i) * kBinWidth, plot.y + plot.height - height, kBinWidth - 1, height}, kBars);
  }
  figure.fill({plot.x, plot.y + plot.height, plot.width, 1}, kFigureSecondInk);
  draw_depth_axis(figure, plot, range_m);
}

}  // namespace

DepthHistogram count_depths(const Image& depth, int bins) {
  assert(depth.channels == 1 && bins > 0);
  DepthHistogram histogram{std::vector<std::int64_t>(static_cast<std::size_t>(bins)), 0};
  for (const float d : depth.texels) {
    if (d == 1.0f) {
      ++histogram.empty;
    } else {
      ++histogram.counts[static_cast<std::size_t>(std::clamp(static_cast<int>(d * static_cast<float>(bins)), 0, bins - 1))];
    }
  }
  return histogram;
}

Image draw_depth_picture(const DepthPicture& picture) {
  constexpr int kBins = (kMapSide - kAxisWidth) / kBinWidth;
  const Range range = find_range(picture.depth);
  const DepthHistogram histogram = count_depths(picture.depth, kBins);
  const Image map = draw_map(picture.depth, range);
  const int line = figure_line_height();
  Figure figure(picture.title, picture.note, {kMapSide + 20, map.height + kPlotHeight + 7 * line});
  const Rect& body = figure.body();
  figure.place(body.x, body.y, map);
  int y = body.y + map.height + line / 4;
  figure.write(body.x, y, fmt::format("black: depth {} · light grey: {} · blue: nothing drawn, {} of {} texels", format_number(static_cast<double>(range.nearest)),
                                      format_number(static_cast<double>(range.farthest)), histogram.empty, picture.depth.texels.size()));
  y += 2 * line;
  figure.write(body.x, y, fmt::format("texels per bin of 1/{} of the depth range (logarithmic)", kBins));
  y += line + line / 2;
  draw_histogram(figure, {body.x + kAxisWidth, y, kBins * kBinWidth, kPlotHeight}, histogram, picture.range_m);
  return figure.canvas();
}

void write_depth_picture(const std::filesystem::path& path, const DepthPicture& picture) {
  write_display_png(path, draw_depth_picture(picture));
}

}  // namespace shadowbench::report
