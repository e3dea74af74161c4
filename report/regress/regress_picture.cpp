#include "report/regress/regress_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/images/color_values.h"
#include "report/images/hardest_edge.h"
#include "report/records/format.h"

namespace shadowbench::regress {
namespace {

using images::Image;
using images::Rect;

constexpr images::Size kBox{540, 1080};  // a crop of 45 pixels fills its width
constexpr images::Rgb kOutline{0.87f, 0.31f, 0.07f};

float distance_from_lit(float v) { return std::isfinite(v) ? 1.0f - v : 2.0f; }
float magnitude(float v) { return std::isfinite(v) ? std::abs(v) : 2.0f; }

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

std::string describe_change(const Comparison& comparison) {
  if (!comparison.pixels) return comparison.findings.front().text;
  const PixelChange& change = *comparison.pixels;
  return fmt::format(
      "{} of {} pixels moved, by {} at most; excused by name: {} where a comparison may flip, {} for rounding",
      change.changed, change.compared, records::format_number(change.max), change.excused_flips,
      change.excused_rounding);
}

/// An image with the crop's outline, over the crop, magnified.
images::Stack show(const std::string& title, const Image& values, const Rect& crop, const images::Badness& badness,
                   const images::Colors& colors) {
  Image whole = images::color_values(images::fit_worst(values, kBox, badness), colors);
  const auto scaled = [&](int place) { return place * whole.width / values.width; };
  images::outline_rect(whole, {scaled(crop.x), scaled(crop.y), scaled(crop.width), scaled(crop.height)}, 1, kOutline);
  const Image part = images::color_values(images::fit_worst(images::cut_image(values, crop), kBox, badness), colors);
  return {{title, "", std::move(whole)}, {"", "", images::frame_image(part, 1, kOutline)}};
}

}  // namespace

void write_regress_picture(const std::filesystem::path& path, const Comparison& comparison, const Image& expected,
                           const Image& actual) {
  Image difference = actual;
  for (std::size_t i = 0; i < difference.texels.size(); ++i) difference.texels[i] -= expected.texels[i];
  const images::ColorScale scale = images::make_signed_scale(images::choose_error_scale({&difference}));
  const Rect crop = crop_worst(difference);
  images::Figure figure{fmt::format("{} on {}: {}", comparison.label, comparison.scene, name_of(comparison.outcome)),
                        comparison.settings + " · " + describe_change(comparison)};
  figure.stacks = {show("expected", expected, crop, distance_from_lit, images::map_grey),
                   show("actual", actual, crop, distance_from_lit, images::map_grey),
                   show("difference", difference, crop, magnitude, scale)};
  figure.legend = {images::make_color_bar(
      scale,
      "actual less expected: darker now (blue), brighter now (red); below: the outlined part, with the largest "
      "difference")};
  images::write_figure(path, figure);
}

}  // namespace shadowbench::regress
