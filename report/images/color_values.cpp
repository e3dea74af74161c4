#include "report/images/color_values.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/images/image_library.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr Rgb kBelow{0.09f, 0.31f, 0.66f};
constexpr Rgb kZero{0.95f, 0.95f, 0.94f};
constexpr Rgb kAbove{0.74f, 0.09f, 0.13f};
constexpr std::array kHatch{0.56f, 0.70f};
constexpr int kMapSteps = 4 * 255 + 1;  // each of 256 even steps is one of them
constexpr int kBarHeight = 18;
constexpr double kSmallestScale = 0.01;
constexpr float kSmallestError = 0.001f;  // a tenth of the smallest scale: nobody sees less

double round_up_nicely(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (value <= step * power * (1.0 + 1e-6)) return step * power;
  return 10.0 * power;
}

}  // namespace

Colors color_map(const std::string& name) {
  Image colors = open_image_library(ErrorKind::kOutput).color_linearly(make_ramp(kMapSteps, 1), name);
  std::ranges::transform(colors.texels, colors.texels.begin(), encode_srgb);
  return [colors = std::move(colors)](float value) {
    const float* color = colors.at(static_cast<int>(std::clamp(value, 0.0f, 1.0f) * (kMapSteps - 1) + 0.5f), 0);
    return Rgb{color[0], color[1], color[2]};
  };
}

Rgb map_grey(float value) {
  if (!std::isfinite(value)) return kMagenta;
  const float grey = std::clamp(value, 0.0f, 1.0f);
  return {grey, grey, grey};
}

Image color_values(const Image& values, const Colors& color_of) {
  Image colors(values.width, values.height, 3);
  for (std::size_t i = 0; i < values.texels.size(); ++i)
    std::ranges::copy(color_of(values.texels[i]), colors.texels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return colors;
}

void hatch_image(Image& colors, const Image& mask) {
  for (int y = 0; y < colors.height; ++y)
    for (int x = 0; x < colors.width; ++x)
      if (*mask.at(x, y) < 0.5f) std::fill_n(colors.at(x, y), 3, kHatch[static_cast<std::size_t>((x + y) / 4 % 2)]);
}

Image make_ramp(int width, int height) {
  Image ramp(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) *ramp.at(x, y) = static_cast<float>(x) / static_cast<float>(width - 1);
  return ramp;
}

Rgb map_diverging(float value, float scale) {
  const float t = std::clamp(value / scale, -1.0f, 1.0f);
  const Rgb& end = t < 0.0f ? kBelow : kAbove;
  Rgb color;
  for (std::size_t i = 0; i < 3; ++i) color[i] = kZero[i] + std::abs(t) * (end[i] - kZero[i]);
  return color;
}

ColorScale make_linear_scale(double low, double high, int parts, Colors color) {
  ColorScale scale{[=](double value) { return (value - low) / (high - low); }, std::move(color), {}};
  for (int i = 0; i <= parts; ++i) {
    const double value = low + (high - low) * i / parts;
    scale.ticks.emplace_back(value, records::format_number(value));
  }
  return scale;
}

ColorScale make_signed_scale(double limit) {
  return make_linear_scale(
      -limit, limit, 4, [](float place) { return map_diverging(2.0f * place - 1.0f, 1.0f); });
}

Rgb ColorScale::operator()(float value) const {
  const double at = std::isfinite(value) ? place(static_cast<double>(value)) : std::nan("");
  return std::isnan(at) ? off_bar(value) : color(static_cast<float>(std::clamp(at, 0.0, 1.0)));
}

Cell make_color_bar(const ColorScale& scale, const std::string& words, int width) {
  Cell cell{"", words, color_values(make_ramp(width, kBarHeight), scale.color)};
  for (const auto& [value, label] : scale.ticks) cell.below.push_back({scale.place(value), label});
  return cell;
}

double choose_error_scale(const std::vector<const Image*>& errors) {
  std::vector<float> magnitudes;
  for (const Image* image : errors) {
    for (const float value : image->texels)
      if (std::isfinite(value) && std::abs(value) >= kSmallestError) magnitudes.push_back(std::abs(value));
  }
  if (magnitudes.empty()) return kSmallestScale;
  const auto rank = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(magnitudes.size() - 1));
  std::nth_element(magnitudes.begin(), magnitudes.begin() + rank, magnitudes.end());
  return round_up_nicely(std::max(kSmallestScale, static_cast<double>(magnitudes[static_cast<std::size_t>(rank)])));
}

}  // namespace shadowbench::images
