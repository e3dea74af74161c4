#include "report/images/heat_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "report/images/color_values.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr Size kHeatBox{640, 1280};
constexpr Rgb kZeroTexel{0.93f, 0.94f, 0.95f};
constexpr Rgb kNotCounted{0.72f, 0.74f, 0.77f};
constexpr Rgb kGround{0.90f, 0.91f, 0.92f};
constexpr double kLeastVarianceDecade = -10.0;  // of the colour bar; the largest is 0

float worst_if_nan(float value, float badness) {
  return std::isnan(value) ? std::numeric_limits<float>::infinity() : badness;
}

/// A heat map over its colour bar.
Stack show_heat(const std::string& title, const std::string& words, const Image& values, const Badness& badness,
                const ColorScale& scale) {
  return {{title, words, color_values(fit_worst(values, kHeatBox, badness), scale)},
          make_color_bar(scale, {}, kHeatBox.width)};
}

/// The bar ends at the largest finite value, rounded up to a multiple of 5.
Stack show_headroom(const Image& headroom, const std::string& caption) {
  float most = 5.0f;
  for (const float value : headroom.texels) most = std::isfinite(value) ? std::max(most, value) : most;
  ColorScale scale = make_linear_scale(0.0, 5.0 * std::ceil(static_cast<double>(most) / 5.0), 4, color_map("viridis"));
  scale.ticks.front().second = "0: the limit";
  scale.off_bar = [](float value) { return value > 0.0f ? kZeroTexel : kMagenta; };
  return show_heat(
      "overflow: what exponents could grow by, per texel of the map", caption, headroom,
      [](float v) { return worst_if_nan(v, -v); }, scale);
}

/// Zero lies in the middle of the bar, with decades on either side; red below it.
Stack show_variance(const Image& variance, const std::string& caption) {
  const auto place = [](double value) {
    if (value == 0.0) return 0.5;
    const double decades = 1.0 - std::log10(std::abs(value)) / kLeastVarianceDecade;
    return 0.5 + std::copysign(0.5 * std::clamp(decades, 0.0, 1.0), value);
  };
  ColorScale scale{place, [](float at) { return map_diverging(1.0f - 2.0f * at, 1.0f); }, {}};
  for (const double value : {-1e-2, -1e-5, -1e-8, 0.0, 1e-8, 1e-5, 1e-2})
    scale.ticks.emplace_back(value, fmt::format("{:g}", value));
  return show_heat(
      "variance before any clamp, per texel of the map", caption, variance, [](float v) { return worst_if_nan(v, -v); },
      scale);
}

Stack show_half_difference(const Image& difference, const std::string& caption) {
  return show_heat(
      "visibility with the 16-bit store less that with the 32-bit store", caption, difference,
      [](float v) { return worst_if_nan(v, std::abs(v)); }, make_signed_scale(choose_error_scale({&difference})));
}

/// Shortfalls, with what rounding does not explain above all colours.
Stack show_bound(const Image& shortfall, const Image& violation, const std::string& caption) {
  assert(violation.texels.size() == shortfall.texels.size());
  Image marked = shortfall;
  for (std::size_t i = 0; i < marked.texels.size(); ++i)
    if (violation.texels[i] > 0.0f) marked.texels[i] = std::numeric_limits<float>::infinity();
  const ColorScale scale = make_linear_scale(0.0, choose_error_scale({&shortfall}), 2, color_map("magma"));
  return show_heat(
      "a bound that must hold: by how much the filter is darker than the PCF of its kernel", caption, marked,
      [](float v) { return worst_if_nan(v, v); }, scale);
}

/// Pale for little: the palest of the map would be lost on the ground, which stands for what is below the scale.
float rank_difference(float value) {
  if (std::isinf(value)) return -1.0f;
  return worst_if_nan(value, std::abs(value));
}

}  // namespace

const std::array<StabilityImage, 5>& list_stability_images() {
  static const std::array<StabilityImage, 5> images{{{"headroom", &StabilityImages::headroom},
                                                     {"variance", &StabilityImages::variance},
                                                     {"half_difference", &StabilityImages::half_difference},
                                                     {"shortfall", &StabilityImages::shortfall},
                                                     {"violation", &StabilityImages::violation}}};
  return images;
}

std::vector<Stack> show_stability(const StabilityImages& images, const std::array<std::string, 4>& captions) {
  std::vector<Stack> stacks;
  if (!images.headroom.empty()) stacks.push_back(show_headroom(images.headroom, captions[0]));
  if (!images.variance.empty()) stacks.push_back(show_variance(images.variance, captions[1]));
  if (!images.half_difference.empty()) stacks.push_back(show_half_difference(images.half_difference, captions[2]));
  if (!images.shortfall.empty()) stacks.push_back(show_bound(images.shortfall, images.violation, captions[3]));
  return stacks;
}

std::vector<Stack> show_difference(const Image& difference, const Image& flip) {
  ColorScale scale = make_signed_scale(choose_error_scale({&difference}));
  scale.off_bar = [](float value) { return std::isnan(value) ? kMagenta : kNotCounted; };
  std::vector<Stack> stacks = {show_heat("signed difference, mean over the channels",
                                         "red: the first is larger; magenta: not finite; grey: left out by the mask",
                                         difference, rank_difference, scale)};
  if (flip.empty()) return stacks;
  const double most = std::max(0.01, static_cast<double>(*std::ranges::max_element(flip.texels)));
  stacks.push_back(show_heat("FLIP", "0: an observer who flips between the pictures sees no change", flip,
                             rank_difference, make_linear_scale(0.0, most, 2, color_map("magma"))));
  return stacks;
}

}  // namespace shadowbench::images
