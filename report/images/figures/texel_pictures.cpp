#include "report/images/figures/texel_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "report/images/color_values.h"
#include "report/images/figures/figure.h"
#include "report/images/picture_io.h"

namespace shadowbench::images {
namespace {

constexpr float kOctaves = 6.0f;  // on either side of one texel per pixel
constexpr Rgb kAway{0.62f, 0.62f, 0.62f};
constexpr Rgb kNoSurface{0.93f, 0.94f, 0.95f};
constexpr int kScaleHeight = 18;
constexpr int kSmallestWidth = 640;  // of a figure: the legend needs it

/// Places densities on the colour bar, [0,1].
float place_density(float density) { return std::clamp(0.5f + 0.5f * std::log2(density) / kOctaves, 0.0f, 1.0f); }

/// Colours values in [0,1]; blue for few, red for many.
Image color_places(const Image& places) { return color_values(places, "turbo"); }

Image color_densities(const Image& density) {
  Image places = density;
  std::transform(density.texels.begin(), density.texels.end(), places.texels.begin(),
                 [](float d) { return d > 0.0f ? place_density(d) : 0.0f; });
  Image colors = color_places(places);
  for (std::size_t i = 0; i < density.texels.size(); ++i) {
    if (density.texels[i] > 0.0f) continue;
    const Rgb& color = density.texels[i] < 0.0f ? kNoSurface : kAway;
    std::copy(color.begin(), color.end(), colors.texels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return colors;
}

void draw_color_bar(Figure& figure, const Rect& bar) {
  figure.place(bar.x, bar.y, color_places(make_ramp(bar.width, bar.height)));
  for (const auto& [density, label] : {std::pair{1.0f / 64.0f, "≤ 1/64"},
                                       {1.0f / 16.0f, "1/16"},
                                       {0.25f, "1/4"},
                                       {1.0f, "1"},
                                       {4.0f, "4"},
                                       {16.0f, "16"},
                                       {64.0f, "≥ 64"}}) {
    const int x = bar.x + static_cast<int>(place_density(density) * static_cast<float>(bar.width - 1));
    figure.fill({x, bar.y + bar.height, 1, 5}, kFigureSecondInk);
    figure.write_centred(x, bar.y + bar.height + 6, label);
  }
}

/// How strong the chessboard is where this many fields fall on a pixel.
float grid_strength(float density) {
  constexpr float kStrength = 0.45f;
  constexpr float kFull = 1.0f / 16.0f, kGone = 1.0f / 4.0f;  // fields of 4 and 2 pixels a side
  if (!(density > 0.0f)) return 0.0f;
  return kStrength * std::clamp(std::log2(kGone / density) / std::log2(kGone / kFull), 0.0f, 1.0f);
}

bool is_dark_field(const float* texel, int field_texels) {
  const auto odd = [&](float place) {
    return (static_cast<std::int64_t>(std::floor(place / static_cast<float>(field_texels))) & 1) != 0;
  };
  return odd(texel[0]) != odd(texel[1]);
}

}  // namespace

Image draw_density_picture(const DensityPicture& picture) {
  assert(picture.density.channels == 1);
  const int line = figure_line_height();
  const int width = std::max(picture.density.width, kSmallestWidth);
  Figure figure(picture.title, picture.note, {width, picture.density.height + 5 * line + kScaleHeight});
  const Rect& body = figure.body();
  figure.place(body.x, body.y, color_densities(picture.density));
  int y = body.y + picture.density.height + line / 2;
  figure.write(body.x, y, "map texels per pixel · white: background");
  figure.write(body.x, y + line, "grey: turned away from the light, or outside its cone or map");
  y += 2 * line + line / 2;
  draw_color_bar(figure, {body.x + 40, y, width - 80, kScaleHeight});
  return figure.canvas();
}

void write_density_picture(const std::filesystem::path& path, const DensityPicture& picture) {
  write_display_png(path, draw_density_picture(picture));
}

int choose_field_texels(const Image& density) {
  constexpr float kFieldPixels = 36.0f;
  std::vector<float> receivers;
  std::copy_if(density.texels.begin(), density.texels.end(), std::back_inserter(receivers),
               [](float d) { return d > 0.0f; });
  if (receivers.empty()) return 1;
  const auto middle = receivers.begin() + static_cast<std::ptrdiff_t>(receivers.size() / 2);
  std::nth_element(receivers.begin(), middle, receivers.end());
  int field = 1;
  while (static_cast<float>(field) * static_cast<float>(field) < kFieldPixels * *middle && field < (1 << 14))
    field *= 2;
  return field;
}

Image draw_texel_grid_picture(const TexelGridPicture& picture) {
  assert(picture.picture.channels == 3 && picture.texel.channels == 2);
  Image shown = picture.picture;
  const int field = choose_field_texels(picture.density);
  for (std::size_t i = 0; i < picture.density.texels.size(); ++i) {
    const float fields_per_pixel = picture.density.texels[i] / static_cast<float>(field * field);
    const float strength = is_dark_field(&picture.texel.texels[2 * i], field) ? grid_strength(fields_per_pixel) : 0.0f;
    for (std::size_t c = 0; c < 3; ++c)
      shown.texels[3 * i + c] = (1.0f - strength) * encode_srgb(picture.picture.texels[3 * i + c]);
  }
  const std::string fields =
      fmt::format("{} · each field of the chessboard is {} × {} texels", picture.note, field, field);
  Figure figure(picture.title, fields, {std::max(shown.width, kSmallestWidth), shown.height});
  figure.place(figure.body().x, figure.body().y, shown);
  return figure.canvas();
}

void write_texel_grid_picture(const std::filesystem::path& path, const TexelGridPicture& picture) {
  write_display_png(path, draw_texel_grid_picture(picture));
}

}  // namespace shadowbench::images
