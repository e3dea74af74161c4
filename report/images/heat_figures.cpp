#include "report/images/heat_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

#include "report/images/color_values.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr Size kPictureBox{kColumnWidth, 560}, kHeatBox{640, 1280};
constexpr Size kPartBox{540, 1080};  // a crop of 45 pixels fills its width
constexpr Rgb kOutline{0.87f, 0.31f, 0.07f};
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

constexpr int kMapSide = 768;  // pixels, of the only map; of one of several, a column
constexpr int kBarWidth = 640;
constexpr Rgb kEmpty{0.80f, 0.87f, 0.95f};
constexpr double kOctaves = 6.0;  // on either side of one texel per pixel
constexpr Rgb kAway{0.62f, 0.62f, 0.62f};
constexpr Rgb kNoSurface{0.93f, 0.94f, 0.95f};

/// Shows the map's texels as squares where it is small, and one of many where it is large.
Image draw_map(const Image& depth, float far_plane, int side, float least, float most) {
  const Image texels = fit_worst(depth, {side, side}, [](float) { return 0.0f; });
  return color_values(texels, [=](float d) {
    const float grey = 0.9f * (d - least) / (most - least);
    return d != far_plane ? Rgb{grey, grey, grey} : kEmpty;
  });
}

/// Shows depths, stretched over the values that occur.
Stack show_layer(const std::string& title, const Image& depth, const filters::DepthCurve& curve, int side) {
  float least = 1.0f, most = 0.0f;
  std::size_t empty = 0;
  for (const float d : depth.texels) {
    if (d == curve.far_plane()) {
      ++empty;
      continue;
    }
    least = std::min(least, d);
    most = std::max(most, d);
  }
  if (!(least < most)) least = 0.0f, most = 1.0f;
  return {{title,
           fmt::format("black: {} · light grey: {} · blue: nothing drawn, {} of {} texels",
                       records::format_number(static_cast<double>(least)),
                       records::format_number(static_cast<double>(most)), empty, depth.texels.size()),
           draw_map(depth, curve.far_plane(), side, least, most)}};
}

/// Places texels per pixel on octaves around one; surfaces that see no light and the background are not on the bar.
ColorScale make_density_scale() {
  ColorScale scale{[](double density) {
                     return density > 0.0 ? 0.5 + 0.5 * std::log2(density) / kOctaves
                                          : std::numeric_limits<double>::quiet_NaN();
                   },
                   color_map("turbo"),  // blue for few, red for many
                   {{1.0 / 64.0, "≤ 1/64"},
                    {1.0 / 16.0, "1/16"},
                    {0.25, "1/4"},
                    {1.0, "1"},
                    {4.0, "4"},
                    {16.0, "16"},
                    {64.0, "≥ 64"}}};
  scale.off_bar = [](float density) { return density < 0.0f ? kNoSurface : kAway; };
  return scale;
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

Image show_picture(const Image& picture, double exposure) {
  Image shown = fit_image(picture, kPictureBox);
  for (float* texel = shown.texels.data(); texel != shown.texels.data() + shown.texels.size(); texel += 3)
    if (std::all_of(texel, texel + 3, [](float value) { return std::isfinite(value); }))
      std::transform(texel, texel + 3, texel, [&](float v) { return encode_srgb(v * static_cast<float>(exposure)); });
    else
      std::ranges::copy(kMagenta, texel);
  return shown;
}

Image show_visibility(const Image& visibility) { return color_values(fit_image(visibility, kPictureBox), map_grey); }

Stack show_part(const Cell& head, const Image& values, const Rect& part, const Badness& badness, const Colors& colors) {
  const auto magnify = [&](const Image& image) { return color_values(fit_worst(image, kPartBox, badness), colors); };
  Cell whole = head;
  whole.picture = magnify(values);
  const auto scaled = [&](int place) { return place * whole.picture.width / values.width; };
  outline_rect(whole.picture, {scaled(part.x), scaled(part.y), scaled(part.width), scaled(part.height)}, 1, kOutline);
  return {whole, {"", "", frame_image(magnify(cut_image(values, part)), 1, kOutline)}};
}

float distance_from_lit(float visibility) { return std::isfinite(visibility) ? 1.0f - visibility : 2.0f; }

Figure show_errors(const std::string& title, const std::vector<ErrorTile>& tiles) {
  std::vector<const Image*> errors;
  for (const ErrorTile& tile : tiles) errors.push_back(&tile.error);
  const ColorScale scale = make_signed_scale(choose_error_scale(errors));
  Figure figure{title};
  for (const ErrorTile& tile : tiles)
    figure.stacks.push_back({{tile.title, tile.words, show_visibility(tile.visibility)},
                             {"", "", color_values(fit_image(tile.error, kPictureBox), scale)}});
  figure.legend = {
      make_color_bar(scale, "below visibility: its error, visibility less truth; blue too dark, red too bright")};
  return figure;
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

std::vector<Stack> show_depth(const std::vector<DepthLayer>& layers, const filters::DepthCurve& curve) {
  std::vector<Stack> stacks;
  const int side = layers.size() > 1 ? kColumnWidth : kMapSide;
  const bool is_linear = curve.is_linear() && !curve.reversed;
  const auto title = [](const DepthLayer& layer, const std::string& what) {
    return layer.name.empty() ? what : layer.name + ": " + what;
  };
  for (const DepthLayer& layer : layers)
    stacks.push_back(
        show_layer(title(layer, is_linear ? "depth, linear as it is stored" : "as stored"), layer.stored, curve, side));
  if (is_linear) return stacks;
  for (const DepthLayer& layer : layers) {
    Image linear = layer.stored;
    for (float& depth : linear.texels) depth = curve.linear(depth);
    stacks.push_back(show_layer(title(layer, "linearised: over the light's range"), linear, {}, side));
  }
  return stacks;
}

Stack show_density(const Image& density) {
  assert(density.channels == 1);
  const ColorScale scale = make_density_scale();
  return {{"", "", color_values(density, scale)},
          make_color_bar(scale,
                         "map texels per pixel · white: background; grey: turned away from the light, or "
                         "outside its cone or map",
                         kBarWidth)};
}

}  // namespace shadowbench::images
