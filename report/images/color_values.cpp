#include "report/images/color_values.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

#include "report/images/picture_io.h"

namespace shadowbench::images {
namespace {

constexpr Rgb kBelow{0.09f, 0.31f, 0.66f};
constexpr Rgb kZero{0.95f, 0.95f, 0.94f};
constexpr Rgb kAbove{0.74f, 0.09f, 0.13f};
constexpr double kSmallestScale = 0.01;
constexpr float kSmallestError = 0.001f;  // a tenth of the smallest scale: nobody sees less

double round_up_nicely(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (value <= step * power * (1.0 + 1e-6)) return step * power;
  return 10.0 * power;
}

}  // namespace

Image color_values(const Image& values, const std::function<Rgb(float)>& color_of) {
  Image colors(values.width, values.height, 3);
  for (std::size_t i = 0; i < values.texels.size(); ++i) {
    const Rgb rgb = color_of(values.texels[i]);
    std::copy(rgb.begin(), rgb.end(), colors.texels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return colors;
}

Image color_values(const Image& values, const std::string& map) {
  const OIIO::ImageSpec spec(values.width, values.height, 1, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf source(spec, const_cast<float*>(values.texels.data()));
  Image colors(values.width, values.height, 3);
  OIIO::ImageBufAlgo::color_map(source, 0, map)
      .get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, colors.texels.data());
  std::ranges::transform(colors.texels, colors.texels.begin(), encode_srgb);  // its tables are linear
  return colors;
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
