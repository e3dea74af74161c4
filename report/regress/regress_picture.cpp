#include "report/regress/regress_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "report/images/color_values.h"
#include "report/images/figures/figure.h"
#include "report/images/figures/fit_worst.h"
#include "report/images/hardest_edge.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::regress {
namespace {

using images::Image;
using images::Rect;
using images::Rgb;

constexpr int kPanelWidth = 420;
constexpr int kGap = 16;
constexpr int kBarWidth = 300;
constexpr Rgb kNotFinite{1.0f, 0.0f, 1.0f};
constexpr Rgb kOutline{0.87f, 0.31f, 0.07f};

using Colors = std::function<Rgb(float)>;

/// One of the images side by side.
struct Panel {
  std::string title;
  Image values;
  images::Badness badness;  ///< how bad the pixels are that share one pixel of the reduced picture
  Colors colors;
};

Rgb color_visibility(float v) {
  return std::isfinite(v) ? Rgb{std::clamp(v, 0.0f, 1.0f), std::clamp(v, 0.0f, 1.0f), std::clamp(v, 0.0f, 1.0f)}
                          : kNotFinite;
}

float distance_from_lit(float v) { return std::isfinite(v) ? 1.0f - v : 2.0f; }
float magnitude(float v) { return std::isfinite(v) ? std::abs(v) : 2.0f; }

Image cut(const Image& image, const Rect& rect) {
  Image part(rect.width, rect.height, 1);
  for (int y = 0; y < rect.height; ++y) std::copy_n(image.at(rect.x, rect.y + y), rect.width, part.at(0, y));
  return part;
}

/// The place where the images differ most.
Rect crop_worst(const Image& difference) {
  const auto smaller = [](float a, float b) { return magnitude(a) < magnitude(b); };
  const int worst = static_cast<int>(std::max_element(difference.texels.begin(), difference.texels.end(), smaller) -
                                     difference.texels.begin());
  const images::Size size = images::choose_crop_size({difference.width, difference.height});
  return {std::clamp(worst % difference.width - size.width / 2, 0, difference.width - size.width),
          std::clamp(worst / difference.width - size.height / 2, 0, difference.height - size.height), size.width,
          size.height};
}

void outline(images::Figure& figure, const Rect& rect) {
  figure.fill({rect.x - 1, rect.y - 1, rect.width + 2, 1}, kOutline);
  figure.fill({rect.x - 1, rect.y + rect.height, rect.width + 2, 1}, kOutline);
  figure.fill({rect.x - 1, rect.y, 1, rect.height}, kOutline);
  figure.fill({rect.x + rect.width, rect.y, 1, rect.height}, kOutline);
}

void frame(images::Figure& figure, int x, int y, const Image& picture) {
  figure.fill({x - 1, y - 1, picture.width + 2, picture.height + 2}, images::kFigureLines);
  figure.place(x, y, picture);
}

std::string describe_change(const Comparison& comparison) {
  if (!comparison.pixels) return comparison.findings.front().text;
  const PixelChange& change = *comparison.pixels;
  return fmt::format(
      "{} of {} pixels moved, by {} at most; excused by name: {} where a comparison may flip, {} for rounding",
      change.changed, change.compared, records::format_number(change.max), change.excused_flips,
      change.excused_rounding);
}

void draw_panel(images::Figure& figure, int column, int y, const Panel& panel, const Rect& crop) {
  const int x = figure.body().x + column * (kPanelWidth + kGap);
  const int below = y + images::figure_line_height() + kPanelWidth * panel.values.height / panel.values.width + kGap;
  figure.write(x, y, panel.title, images::kFigureInk);
  frame(figure, x, y + images::figure_line_height(),
        images::color_values(images::fit_worst(panel.values, kPanelWidth, panel.badness), panel.colors));
  const auto scaled = [&](int place) { return place * kPanelWidth / panel.values.width; };
  outline(figure, {x + scaled(crop.x), y + images::figure_line_height() + scaled(crop.y), scaled(crop.width),
                   scaled(crop.height)});
  const Image magnified =
      images::color_values(images::fit_worst(cut(panel.values, crop), kPanelWidth, panel.badness), panel.colors);
  frame(figure, x, below, magnified);
  outline(figure, {x, below, magnified.width, magnified.height});
}

void draw_scale(images::Figure& figure, int top, double scale) {
  const Image bar = images::make_ramp(kBarWidth, images::figure_line_height() - 4);
  figure.place(figure.body().x, top + 2,
               images::color_values(bar, [](float t) { return images::map_diverging(2.0f * t - 1.0f, 1.0f); }));
  figure.write(figure.body().x + kBarWidth + kGap, top,
               fmt::format("actual less expected: -{0} (darker now) to +{0} (brighter now); below: the outlined part, "
                           "with the largest difference",
                           records::format_number(scale)));
}

}  // namespace

void write_regress_picture(const std::filesystem::path& path, const Comparison& comparison, const Image& expected,
                           const Image& actual) {
  Image difference = actual;
  for (std::size_t i = 0; i < difference.texels.size(); ++i) difference.texels[i] -= expected.texels[i];
  const double scale = images::choose_error_scale({&difference});
  const Rect crop = crop_worst(difference);
  const std::vector<Panel> panels = {{"expected", expected, distance_from_lit, color_visibility},
                                     {"actual", actual, distance_from_lit, color_visibility},
                                     {"difference", difference, magnitude, [scale](float v) {
                                        return std::isfinite(v) ? images::map_diverging(v, static_cast<float>(scale))
                                                                : kNotFinite;
                                      }}};
  const int line = images::figure_line_height(), width = 3 * kPanelWidth + 2 * kGap;
  const std::vector<std::string> notes = images::wrap_figure_text(describe_change(comparison), width);
  const int top = line * static_cast<int>(notes.size()), height = top + line +
                                                                  kPanelWidth * actual.height / actual.width + kGap +
                                                                  kPanelWidth * crop.height / crop.width + kGap;
  images::Figure figure(fmt::format("{} on {}: {}", comparison.label, comparison.scene, name_of(comparison.outcome)),
                        comparison.settings, {width, height + line});
  for (std::size_t i = 0; i < notes.size(); ++i)
    figure.write(figure.body().x, figure.body().y + line * static_cast<int>(i), notes[i]);
  for (std::size_t i = 0; i < panels.size(); ++i)
    draw_panel(figure, static_cast<int>(i), figure.body().y + top, panels[i], crop);
  draw_scale(figure, figure.body().y + height, scale);
  images::write_display_png(path, figure.canvas());
}

}  // namespace shadowbench::regress
