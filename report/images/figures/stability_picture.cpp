#include "report/images/figures/stability_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>

#include "report/images/color_values.h"
#include "report/images/figures/heat_panels.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr Rgb kBroken{1.0f, 0.0f, 1.0f};
constexpr Rgb kZeroTexel{0.93f, 0.94f, 0.95f};
constexpr double kLeastVarianceDecade = -10.0;  // of the colour bar; the largest is 0

/// Colours values in [0,1], dark for little.
Image color_sequential(const Image& values) { return color_values(values, "viridis"); }

float worst_if_nan(float value, float badness) {
  return std::isnan(value) ? std::numeric_limits<float>::infinity() : badness;
}

/// The largest finite value, rounded up to a multiple of 5: the end of the headroom's colour bar.
float choose_headroom_scale(const Image& headroom) {
  float most = 0.0f;
  for (const float value : headroom.texels) most = std::isfinite(value) ? std::max(most, value) : most;
  return std::max(5.0f, 5.0f * std::ceil(most / 5.0f));
}

HeatPanel make_headroom_panel(const StabilityPicture& picture) {
  const Image& headroom = picture.images.headroom;
  const float scale = choose_headroom_scale(headroom);
  const Image shown = fit_heat_panel(headroom, [](float v) { return worst_if_nan(v, -v); });
  Image places = shown;
  for (float& value : places.texels) value = std::isfinite(value) ? std::clamp(value / scale, 0.0f, 1.0f) : 0.0f;
  HeatPanel panel{"overflow: what exponents could grow by, per texel of the map",
                  picture.texels,
                  color_sequential(places),
                  color_sequential(make_color_bar()),
                  {}};
  for (std::size_t i = 0; i < shown.texels.size(); ++i) {
    const float value = shown.texels[i];
    if (std::isfinite(value)) continue;
    const Rgb& rgb = value > 0.0f ? kZeroTexel : kBroken;
    std::copy(rgb.begin(), rgb.end(), panel.picture.texels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  for (const float part : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
    panel.ticks.emplace_back(part, records::format_number(static_cast<double>(part * scale)));
  panel.ticks.front().second = "0: the limit";
  return panel;
}

/// Places a variance on a bar with zero in the middle and decades on either side, [-1,1].
float place_variance(float variance) {
  if (variance == 0.0f) return 0.0f;
  const double decades = std::log10(std::abs(static_cast<double>(variance)));
  return std::copysign(static_cast<float>(std::clamp(1.0 - decades / kLeastVarianceDecade, 0.0, 1.0)), variance);
}

HeatPanel make_variance_panel(const StabilityPicture& picture) {
  const Image shown = fit_heat_panel(
      picture.images.variance, [](float v) { return worst_if_nan(v, -v); });
  const auto color_of = [](float v) { return std::isfinite(v) ? map_diverging(-place_variance(v), 1.0f) : kBroken; };
  HeatPanel panel{"variance before any clamp, per texel of the map",
                  picture.variance,
                  color_values(shown, color_of),
                  color_values(make_color_bar(), [](float t) { return map_diverging(1.0f - 2.0f * t, 1.0f); }),
                  {}};
  for (const float variance : {-1e-2f, -1e-5f, -1e-8f, 0.0f, 1e-8f, 1e-5f, 1e-2f})
    panel.ticks.emplace_back(0.5f + 0.5f * place_variance(variance), fmt::format("{:g}", variance));
  return panel;
}

HeatPanel make_difference_panel(const StabilityPicture& picture) {
  const Image& difference = picture.images.half_difference;
  const double scale = choose_error_scale({&difference});
  const Image shown = fit_heat_panel(
      difference, [](float v) { return worst_if_nan(v, std::abs(v)); });
  const auto color_of = [scale](float v) {
    return std::isfinite(v) ? map_diverging(v, static_cast<float>(scale)) : kBroken;
  };
  return {"visibility with the 16-bit store less that with the 32-bit store", picture.difference,
          color_values(shown, color_of),
          color_values(make_color_bar(), [](float t) { return map_diverging(2.0f * t - 1.0f, 1.0f); }),
          list_signed_ticks(scale)};
}

/// Shortfalls, with what rounding does not explain above all colours.
HeatPanel make_bound_panel(const StabilityPicture& picture) {
  const Image& shortfall = picture.images.shortfall;
  assert(picture.images.violation.texels.size() == shortfall.texels.size());
  const double scale = choose_error_scale({&shortfall});
  Image marked = shortfall;
  for (std::size_t i = 0; i < marked.texels.size(); ++i)
    if (picture.images.violation.texels[i] > 0.0f) marked.texels[i] = std::numeric_limits<float>::infinity();
  const Image shown = fit_heat_panel(
      marked, [](float v) { return worst_if_nan(v, v); });
  const auto color_of = [scale](float v) {
    return std::isfinite(v) ? map_diverging(-v, static_cast<float>(scale)) : kBroken;
  };
  HeatPanel panel{"a bound that must hold: by how much the filter is darker than the PCF of its kernel",
                  picture.bound,
                  color_values(shown, color_of),
                  color_values(make_color_bar(), [](float t) { return map_diverging(-t, 1.0f); }),
                  {}};
  for (const float part : {0.0f, 0.5f, 1.0f})
    panel.ticks.emplace_back(part, records::format_number(static_cast<double>(part) * scale));
  return panel;
}

std::vector<HeatPanel> make_heat_panels(const StabilityPicture& picture) {
  std::vector<HeatPanel> panels;
  const StabilityImages& images = picture.images;
  if (!images.headroom.empty()) panels.push_back(make_headroom_panel(picture));
  if (!images.variance.empty()) panels.push_back(make_variance_panel(picture));
  if (!images.half_difference.empty()) panels.push_back(make_difference_panel(picture));
  if (!images.shortfall.empty()) panels.push_back(make_bound_panel(picture));
  return panels;
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

Image draw_stability_picture(const StabilityPicture& picture) {
  return draw_heat_panels(picture.title, picture.note, make_heat_panels(picture));
}

void write_stability_picture(const std::filesystem::path& path, const StabilityPicture& picture) {
  write_display_png(path, draw_stability_picture(picture));
}

}  // namespace shadowbench::images
