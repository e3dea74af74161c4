#include "report/images/attribution_bar.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace shadowbench::images {
namespace {

constexpr double kSmallestLength = 0.001;
constexpr int kOverhang = 4;
constexpr int kTickWidth = 3;
constexpr Rgb kTrack{0.95f, 0.95f, 0.95f}, kZeroLine{0.45f, 0.47f, 0.50f}, kTickInk{0.0f, 0.0f, 0.0f};

double round_up_length(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (value <= step * power * (1.0 + 1e-9)) return step * power;
  return 10.0 * power;
}

}  // namespace

double AttributionBar::net() const { return std::accumulate(lengths.begin(), lengths.end(), 0.0); }

std::optional<AttributionBar> make_attribution_bar(const records::CellRecord& cell) {
  const auto shares = records::list_shares(cell);
  if (cell.status == records::CellStatus::kSuspect || !shares || !cell.error.rmse || !std::isfinite(*cell.error.rmse))
    return std::nullopt;
  AttributionBar bar;
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i) bar.lengths[i] = (*shares)[i].value_or(0.0) * *cell.error.rmse;
  return bar;
}

std::vector<BarSegment> stack_segments(const AttributionBar& bar) {
  std::vector<BarSegment> segments;
  double left = 0.0;
  double right = 0.0;
  for (std::size_t part = 0; part < metrics::kErrorParts; ++part) {
    const double length = bar.lengths[part];
    if (length > 0.0) {
      segments.push_back({part, right, right + length});
      right += length;
    } else if (length < 0.0) {
      segments.push_back({part, left + length, left});
      left += length;
    }
  }
  return segments;
}

BarScale choose_bar_scale(const std::vector<AttributionBar>& bars) {
  double below = 0.0;
  double above = 0.0;
  for (const AttributionBar& bar : bars) {
    for (const BarSegment& segment : stack_segments(bar)) {
      below = std::max(below, -segment.begin);
      above = std::max(above, segment.end);
    }
  }
  return {below, round_up_length(std::max(kSmallestLength, below + above))};
}

Image draw_bar(const AttributionBar& bar, const BarScale& scale, Size size) {
  assert(size.height > 2 * kOverhang && scale.length > 0.0);
  Image image(size.width, size.height, 3);
  const auto pixel = [&](double value) { return static_cast<int>(std::lround(scale.place(value) * size.width)); };
  const auto draw_line = [&](double value, int width, const Rgb& color) {
    fill_rect(image, {std::clamp(pixel(value) - width / 2, 0, size.width - width), 0, width, size.height}, color);
  };
  const int height = size.height - 2 * kOverhang;
  fill_rect(image, {0, 0, size.width, size.height}, {1.0f, 1.0f, 1.0f});
  fill_rect(image, {0, kOverhang, size.width, height}, kTrack);
  draw_line(0.0, 1, kZeroLine);
  for (const BarSegment& segment : stack_segments(bar))
    fill_rect(image, {pixel(segment.begin), kOverhang, pixel(segment.end) - pixel(segment.begin), height},
              records::list_error_parts()[segment.part].color);
  draw_line(bar.net(), kTickWidth, kTickInk);
  return image;
}

}  // namespace shadowbench::images
