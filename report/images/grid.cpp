#include "report/images/grid.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "report/images/color_values.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

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

constexpr Rgb kOutline{0.93f, 0.32f, 0.05f};
constexpr int kOutlineWidth = 2;
constexpr Size kPictureBox{kColumnWidth, 560};
constexpr int kCropGap = 10;
constexpr Size kCropBox{(kColumnWidth - kCropGap) / 2 - 2 * kOutlineWidth, 260};
constexpr Size kBarSize{kColumnWidth, 30};
constexpr int kPartsWidth = 720;  // the longest name has room beside its neighbours

/// What all tiles of a grid share.
struct Shared {
  std::optional<ColorScale> errors;
  std::optional<BarScale> bars;
};

Shared choose_shared(const Grid& grid) {
  std::vector<const Image*> errors;
  std::vector<AttributionBar> bars;
  for (const GridTile& tile : grid.tiles) {
    if (!tile.error.empty()) errors.push_back(&tile.error);
    if (tile.attribution) bars.push_back(*tile.attribution);
  }
  Shared shared;
  if (!errors.empty())
    shared.errors = make_signed_scale(grid.error_scale ? *grid.error_scale : choose_error_scale(errors));
  if (!bars.empty()) shared.bars = choose_bar_scale(bars);
  return shared;
}

Rect clip_crop(const Rect& crop, const Image& image) {
  const int left = std::clamp(crop.x, 0, image.width), right = std::clamp(crop.x + crop.width, left, image.width);
  const int top = std::clamp(crop.y, 0, image.height), bottom = std::clamp(crop.y + crop.height, top, image.height);
  return {left, top, right - left, bottom - top};
}

/// Turns visibility, hatched where `mask` says so, or a linear picture into display values.
Image display(Image image, const Image& mask, double exposure) {
  if (image.channels == 1) {
    Image grey = color_values(image, map_grey);
    if (!mask.empty()) hatch_image(grey, mask);
    return grey;
  }
  for (float* texel = image.texels.data(); texel != image.texels.data() + image.texels.size(); texel += 3)
    if (std::all_of(texel, texel + 3, [](float value) { return std::isfinite(value); }))
      std::transform(texel, texel + 3, texel, [&](float v) { return encode_srgb(v * static_cast<float>(exposure)); });
    else
      std::ranges::copy(kMagenta, texel);
  return image;
}

/// Shows the whole of an image with the crop's outline, which does not leave it.
Image show(const Image& image, const Grid& grid) {
  Image shown = display(fit_image(image, kPictureBox), fit_image(grid.mask, kPictureBox), grid.exposure);
  const Rect crop = clip_crop(grid.crop, image);
  if (crop.width == 0 || crop.height == 0) return shown;
  const double sx = static_cast<double>(shown.width) / image.width,
               sy = static_cast<double>(shown.height) / image.height;
  const int left = static_cast<int>(std::floor(crop.x * sx)), top = static_cast<int>(std::floor(crop.y * sy));
  outline_rect(shown,
               {left, top, static_cast<int>(std::ceil((crop.x + crop.width) * sx)) - left,
                static_cast<int>(std::ceil((crop.y + crop.height) * sy)) - top},
               kOutlineWidth, kOutline);
  return shown;
}

/// Shows the crops of a picture and of its visibility, those that there are, side by side, each in its outline.
Image show_crops(const GridTile& tile, const Grid& grid) {
  std::vector<Image> crops;
  Size size{-kCropGap, 0};
  for (const Image* image : {&tile.picture, &tile.visibility}) {
    const Rect crop = clip_crop(grid.crop, *image);
    if (crop.width == 0 || crop.height == 0) continue;
    const Image mask = grid.mask.empty() ? Image() : fit_image(cut_image(grid.mask, crop), kCropBox);
    const Image part = display(fit_image(cut_image(*image, crop), kCropBox), mask, grid.exposure);
    crops.push_back(frame_image(part, kOutlineWidth, kOutline));
    size.width += crops.back().width + kCropGap;
    size.height = std::max(size.height, crops.back().height);
  }
  if (crops.empty()) return {};
  Image shown(size.width, size.height, 3);
  std::ranges::fill(shown.texels, 1.0f);
  int x = 0;
  for (const Image& crop : crops) {
    paste_image(shown, crop, x, 0);
    x += crop.width + kCropGap;
  }
  return shown;
}

Stack make_stack(const GridTile& tile, const Grid& grid, const Shared& shared) {
  Stack stack(kCropCell + 1);
  stack[kPictureCell].title = tile.label;
  stack[kPictureCell].words = tile.caption;
  if (tile.picture.empty() && tile.visibility.empty() && tile.error.empty()) {
    stack[kPictureCell].warning = tile.message;
    return stack;
  }
  stack[kPictureCell].picture = show(tile.picture, grid);
  stack[kVisibilityCell].picture = show(tile.visibility, grid);
  if (!tile.error.empty()) stack[kErrorCell].picture = color_values(fit_image(tile.error, kPictureBox), *shared.errors);
  if (shared.bars) stack[kBarCell].words = tile.attribution_words;
  if (tile.attribution) stack[kBarCell].picture = draw_bar(*tile.attribution, *shared.bars, kBarSize);
  stack[kCropCell].picture = show_crops(tile, grid);
  return stack;
}

/// The parts' colours, each over its name.
ColorScale make_parts_scale() {
  constexpr auto kCount = static_cast<double>(metrics::kErrorParts);
  ColorScale scale{[](double part) { return (part + 0.5) / kCount; },
                   [](float place) {
                     const auto part = static_cast<std::size_t>(static_cast<double>(place) * kCount);
                     return records::list_error_parts()[std::min(part, metrics::kErrorParts - 1)].color;
                   },
                   {}};
  for (std::size_t part = 0; part < metrics::kErrorParts; ++part)
    scale.ticks.emplace_back(static_cast<double>(part), records::list_error_parts()[part].name);
  return scale;
}

std::string explain_rows(const Grid& grid, const Shared& shared) {
  std::string words = "Top: shaded picture. Below it: visibility (white lit, black blocked";
  words += grid.mask.empty() ? ")" : ", hatched no receiver)";
  words += shared.errors ? ", then its error" : "";
  words += shared.bars ? ", then the parts of the error." : ".";
  if (grid.crop.width == 0) return words;
  const int factor = fit_size({grid.crop.width, grid.crop.height}, kCropBox).width / grid.crop.width;
  return words + " Bottom: the outlined part of both" + (factor > 1 ? fmt::format(", {} times larger.", factor) : ".");
}

Stack make_legend(const Grid& grid, const Shared& shared) {
  Stack legend;
  if (shared.errors)
    legend.push_back(
        make_color_bar(*shared.errors, "error, visibility less area truth: blue too dark, red too bright"));
  if (shared.bars) {
    const std::string words = fmt::format(
        "Bars: what the error is made of, each part's share times RMSE; parts left of the grey line offset the others. "
        "The black tick is the RMSE, the full width {}.",
        records::format_number(shared.bars->length));
    legend.push_back(make_color_bar(make_parts_scale(), words, kPartsWidth));
  }
  const auto shows = [](const GridTile& tile) { return !tile.visibility.empty(); };
  if (std::ranges::any_of(grid.tiles, shows)) legend.push_back({"", explain_rows(grid, shared)});
  return legend;
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

Figure make_figure(const Grid& grid) {
  const Shared shared = choose_shared(grid);
  Figure figure{grid.title, grid.subtitle, {}, grid.columns, make_legend(grid, shared)};
  figure.stacks.resize(grid.tiles.size());
  tbb::parallel_for(std::size_t{0}, grid.tiles.size(),
                    [&](std::size_t i) { figure.stacks[i] = make_stack(grid.tiles[i], grid, shared); });
  return figure;
}

void write_grid(const std::filesystem::path& path, const Grid& grid) { write_figure(path, make_figure(grid)); }

}  // namespace shadowbench::images
