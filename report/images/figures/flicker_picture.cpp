#include "report/images/figures/flicker_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/images/color_values.h"
#include "report/images/figures/figure.h"
#include "report/images/figures/fit_worst.h"
#include "report/images/picture_io.h"

namespace shadowbench::images {
namespace {

constexpr int kPanelWidth = 400;
constexpr int kGap = 10;
constexpr int kBarWidth = 400;
constexpr std::size_t kPerRow = 2;  // filters, each with two panels
constexpr double kLeastShown = 1e-3;
constexpr Rgb kGround{0.90f, 0.91f, 0.92f};

/// A single pixel that flickers is seen.
Image fit_panel(const Image& image) {
  return fit_worst(
      image, kPanelWidth, [](float flicker) { return flicker; });
}

/// Colours a place on the scale, [0,1], pale for little; what is below is the ground.
Image color(Image places) {
  const Image given = places;
  for (float& place : places.texels)
    place = 0.95f * (1.0f - std::clamp(place, 0.0f, 1.0f));  // the palest of the map would be lost on the ground
  Image colors = color_values(places, "inferno");
  for (std::size_t i = 0; i < given.texels.size(); ++i)
    if (given.texels[i] < 0.0f) std::ranges::copy(kGround, colors.texels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return colors;
}

Image color_flicker(Image flicker) {
  for (float& value : flicker.texels)
    value = static_cast<float>(place_flicker(static_cast<double>(value)).value_or(-1.0));
  return color(std::move(flicker));
}

void draw_scale(Figure& figure, int top) {
  const int line = figure_line_height(), left = figure.body().x + 3 * kGap;  // room for the first number
  figure.place(left, top + 2, color(make_ramp(kBarWidth, line - 4)));
  for (const double tick : {0.001, 0.01, 0.1, 1.0}) {
    figure.write_centred(left + static_cast<int>(*place_flicker(tick) * kBarWidth), top + line,
                         fmt::format("{:g}", tick));
  }
  figure.write(left + kBarWidth + 4 * kGap, top, "grey: less than 0.001; the largest is shown where pixels share one");
}

}  // namespace

std::optional<double> place_flicker(double flicker) {
  if (!(flicker >= kLeastShown)) return std::nullopt;
  return std::min(1.0, 1.0 - std::log10(flicker) / std::log10(kLeastShown));
}

void write_flicker_picture(const std::filesystem::path& path, const FlickerPicture& picture) {
  const Image& first = picture.tiles.front().free;
  const int line = figure_line_height(), panel_height = std::max(1, first.height * kPanelWidth / first.width);
  const int row_height = line + panel_height + 2 * kGap, pair_width = 2 * kPanelWidth + kGap;
  const int columns = static_cast<int>(std::min(kPerRow, picture.tiles.size()));
  const int rows = static_cast<int>((picture.tiles.size() + kPerRow - 1) / kPerRow);
  Figure figure(picture.title, picture.note,
                {columns * pair_width + (columns - 1) * 3 * kGap, rows * row_height + 2 * line});
  for (std::size_t i = 0; i < picture.tiles.size(); ++i) {
    const FlickerTile& tile = picture.tiles[i];
    const int x = figure.body().x + static_cast<int>(i % kPerRow) * (pair_width + 3 * kGap);
    const int y = figure.body().y + static_cast<int>(i / kPerRow) * row_height;
    figure.write(x, y, tile.filter, kFigureInk);
    figure.write(x + kPanelWidth + kGap, y, "snapped");
    figure.place(x, y + line, color_flicker(fit_panel(tile.free)));
    figure.place(x + kPanelWidth + kGap, y + line, color_flicker(fit_panel(tile.snapped)));
  }
  draw_scale(figure, figure.body().y + rows * row_height);
  write_display_png(path, figure.canvas());
}

}  // namespace shadowbench::images
