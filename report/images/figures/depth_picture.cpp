#include "report/images/figures/depth_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "report/images/figures/figure.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr int kMapSide = 768, kLayerSide = 384;  // pixels, of the only map and of one of several
constexpr int kPlotHeight = 220;
constexpr int kAxisWidth = 90;  // for the counts' labels
constexpr int kBinWidth = 4;
constexpr Rgb kEmpty{0.80f, 0.87f, 0.95f};
constexpr Rgb kBars{0.20f, 0.36f, 0.60f};

/// One map with its histogram.
struct DepthPanel {
  std::string title;
  Image depth;
  filters::DepthCurve curve;  ///< says what depth a value stands for
  double range_m = 0.0;
  int width = 0;  ///< pixels

  int bins() const { return (width - kAxisWidth) / kBinWidth; }
  int map_side() const { return depth.width >= width ? width : depth.width * (width / depth.width); }
};

struct Range {
  float least = 1.0f;
  float most = 0.0f;
};

Range find_range(const DepthPanel& panel) {
  Range range;
  for (const float d : panel.depth.texels) {
    if (d == panel.curve.far_plane()) continue;
    range.least = std::min(range.least, d);
    range.most = std::max(range.most, d);
  }
  return range.least < range.most ? range : Range{0.0f, 1.0f};
}

/// Shows the map's texels as squares where it is small, and one of many where it is large.
Image draw_map(const DepthPanel& panel, const Range& range) {
  const Image& depth = panel.depth;
  const int side = panel.map_side();
  Image map(side, side, 3);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto texel = [&](int at) { return static_cast<int>(static_cast<std::int64_t>(at) * depth.width / side); };
      const float d = *depth.at(texel(x), texel(y));
      const float grey = 0.9f * (d - range.least) / (range.most - range.least);
      const Rgb color = d != panel.curve.far_plane() ? Rgb{grey, grey, grey} : kEmpty;
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
    figure.write_before(plot.x - 8, y - figure_line_height() / 2,
                        fmt::format("{}", static_cast<std::int64_t>(std::pow(10.0, decade))));
  }
}

void draw_depth_axis(Figure& figure, const Rect& plot, const filters::DepthCurve& curve, double range_m) {
  const int top = plot.y + plot.height + 8;
  const int quarters = plot.width > kLayerSide ? 1 : 2;  // labels need room
  for (int quarter = 0; quarter <= 4; quarter += quarters) {
    const double value = 0.25 * quarter;
    const int x = plot.x + static_cast<int>(value * plot.width);
    figure.fill({x, plot.y + plot.height, 1, 6}, kFigureSecondInk);
    figure.write_centred(x, top, records::format_number(value));
    figure.write_centred(x, top + figure_line_height(), records::format_number(curve.linear(value) * range_m) + " m");
  }
}

void draw_histogram(Figure& figure, const Rect& plot, const DepthHistogram& histogram, const filters::DepthCurve& curve,
                    double range_m) {
  const int decades = count_decades(histogram);
  draw_count_axis(figure, plot, decades);
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    // One texel still shows: it stands on the axis two pixels high.
    const int height =
        2 + static_cast<int>(std::log10(static_cast<double>(histogram.counts[i])) / decades * (plot.height - 2));
    figure.fill({plot.x + static_cast<int>(i) * kBinWidth, plot.y + plot.height - height, kBinWidth - 1, height},
                kBars);
  }
  figure.fill({plot.x, plot.y + plot.height, plot.width, 1}, kFigureSecondInk);
  draw_depth_axis(figure, plot, curve, range_m);
}

/// Draws the panel with its left top corner at (x, y).
void draw_panel(Figure& figure, int x, int y, const DepthPanel& panel) {
  const Range range = find_range(panel);
  const DepthHistogram histogram = count_depths(panel.depth, panel.bins(), panel.curve.far_plane());
  const Image map = draw_map(panel, range);
  const int line = figure_line_height();
  figure.write(x, y, panel.title);
  y += line + line / 4;
  figure.place(x, y, map);
  y += map.height + line / 4;
  figure.write(x, y,
               fmt::format("black: {} · light grey: {}", records::format_number(static_cast<double>(range.least)),
                           records::format_number(static_cast<double>(range.most))));
  y += line;
  figure.write(x, y, fmt::format("blue: nothing drawn, {} of {} texels", histogram.empty, panel.depth.texels.size()));
  y += 2 * line;
  figure.write(x, y, fmt::format("texels per 1/{} of the values (logarithmic)", panel.bins()));
  y += line + line / 2;
  draw_histogram(figure, {x + kAxisWidth, y, panel.bins() * kBinWidth, kPlotHeight}, histogram, panel.curve,
                 panel.range_m);
}

/// As stored first; the rest is what cannot be seen in that.
std::vector<DepthPanel> make_panels(const DepthLayer& layer, const filters::DepthCurve& curve, int width) {
  const std::string before = layer.name.empty() ? "" : layer.name + ": ";
  if (curve.is_linear() && !curve.reversed)
    return {{before + "depth, linear as it is stored", layer.stored, {}, layer.range_m, width}};
  Image linear = layer.stored;
  for (float& depth : linear.texels) depth = curve.linear(depth);
  return {{before + "as stored", layer.stored, curve, layer.range_m, width},
          {before + "linearised: depth over the light's range", std::move(linear), {}, layer.range_m, width}};
}

}  // namespace

DepthHistogram count_depths(const Image& depth, int bins, float far_plane) {
  assert(depth.channels == 1 && bins > 0);
  DepthHistogram histogram{std::vector<std::int64_t>(static_cast<std::size_t>(bins)), 0};
  for (const float d : depth.texels) {
    if (d == far_plane) {
      ++histogram.empty;
    } else {
      ++histogram
            .counts[static_cast<std::size_t>(std::clamp(static_cast<int>(d * static_cast<float>(bins)), 0, bins - 1))];
    }
  }
  return histogram;
}

Image draw_depth_picture(const DepthPicture& picture) {
  const bool is_layered = picture.layers.size() > 1;
  const int width = is_layered ? kLayerSide : kMapSide, panel_width = width + 20, gap = is_layered ? 40 : 60;
  const int line = figure_line_height();
  std::vector<std::vector<DepthPanel>> layers;
  for (const DepthLayer& layer : picture.layers) layers.push_back(make_panels(layer, picture.curve, width));
  const int kinds = static_cast<int>(layers.front().size()), count = static_cast<int>(layers.size());
  const int columns = is_layered ? count : kinds, rows = is_layered ? kinds : 1;
  const int panel_height = layers.front().front().map_side() + kPlotHeight + 9 * line + line / 2;
  Figure figure(picture.title, picture.note, {columns * (panel_width + gap) - gap, rows * panel_height});
  for (int layer = 0; layer < count; ++layer) {
    for (int kind = 0; kind < kinds; ++kind) {
      const int column = is_layered ? layer : kind, row = is_layered ? kind : 0;
      draw_panel(figure, figure.body().x + column * (panel_width + gap), figure.body().y + row * panel_height,
                 layers[static_cast<std::size_t>(layer)][static_cast<std::size_t>(kind)]);
    }
  }
  return figure.canvas();
}

void write_depth_picture(const std::filesystem::path& path, const DepthPicture& picture) {
  write_display_png(path, draw_depth_picture(picture));
}

}  // namespace shadowbench::images
