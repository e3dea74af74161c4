#include "report/images/attribution_bar.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace shadowbench::images {
namespace {

constexpr double kSmallestLength = 0.001;
constexpr double kSmallestLabelledShare = 0.01;
constexpr std::size_t kLabelledParts = 2;
constexpr int kOverhang = 4;
constexpr int kTickWidth = 3;

double round_up_length(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (value <= step * power * (1.0 + 1e-9)) return step * power;
  return 10.0 * power;
}

// A line of `width` pixels centred on `x`, kept inside the box.
Rect place_line(int x, int width, const Rect& box) {
  return {std::clamp(x - width / 2, box.x, box.x + box.width - width), box.y, width, box.height};
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

std::string label_bar(const AttributionBar& bar) {
  const double net = bar.net();
  if (!(net > 0.0)) return {};
  std::array<std::size_t, metrics::kErrorParts> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return std::abs(bar.lengths[a]) > std::abs(bar.lengths[b]); });
  std::vector<std::string> texts;
  for (const std::size_t part : order) {
    const double share = bar.lengths[part] / net;
    if (texts.size() < kLabelledParts && std::abs(share) >= kSmallestLabelledShare)
      texts.push_back(fmt::format("{} {}", records::list_error_parts()[part].id, records::format_share(share)));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
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

BarPlace place_bar(const AttributionBar& bar, const BarScale& scale, const Rect& box, std::size_t tile) {
  assert(box.height > 2 * kOverhang && scale.length > 0.0);
  const auto pixel = [&](double value) {
    return box.x + static_cast<int>(std::lround(scale.place(value) * box.width));
  };
  const Rect track{box.x, box.y + kOverhang, box.width, box.height - 2 * kOverhang};
  BarPlace place{box, track, place_line(pixel(0.0), 1, box), place_line(pixel(bar.net()), kTickWidth, box), tile, {}};
  for (const BarSegment& segment : stack_segments(bar)) {
    const int begin = pixel(segment.begin);
    const int end = pixel(segment.end);
    if (end > begin) place.segments.push_back({{begin, track.y, end - begin, track.height}, segment.part});
  }
  return place;
}

}  // namespace shadowbench::images
