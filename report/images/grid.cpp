#include "report/images/grid.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "report/images/color_values.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr Rgb kOutline{0.93f, 0.32f, 0.05f};
constexpr int kOutlineWidth = 2;
constexpr Size kPictureBox{kColumnWidth, 560};
constexpr int kCropGap = 10;
constexpr Size kCropBox{(kColumnWidth - kCropGap) / 2 - 2 * kOutlineWidth, 260};

/// The scale of all errors of a grid; nothing where there are none.
std::optional<ColorScale> choose_error_colors(const Grid& grid) {
  std::vector<const Image*> errors;
  for (const GridTile& tile : grid.tiles)
    if (!tile.error.empty()) errors.push_back(&tile.error);
  return errors.empty() ? std::nullopt : std::optional(make_signed_scale(choose_error_scale(errors)));
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

Stack make_stack(const GridTile& tile, const Grid& grid, const std::optional<ColorScale>& errors) {
  Stack stack(kCropCell + 1);
  stack[kPictureCell].title = tile.label;
  stack[kPictureCell].words = tile.caption;
  if (tile.picture.empty() && tile.visibility.empty() && tile.error.empty()) {
    stack[kPictureCell].warning = tile.message;
    return stack;
  }
  stack[kPictureCell].picture = show(tile.picture, grid);
  stack[kVisibilityCell].picture = show(tile.visibility, grid);
  if (!tile.error.empty()) stack[kErrorCell].picture = color_values(fit_image(tile.error, kPictureBox), *errors);
  stack[kCropCell].picture = show_crops(tile, grid);
  return stack;
}

std::string explain_rows(const Grid& grid, bool has_errors) {
  std::string words = "Top: shaded picture. Below it: visibility (white lit, black blocked";
  words += grid.mask.empty() ? ")" : ", hatched no receiver)";
  words += has_errors ? ", then its error." : ".";
  if (grid.crop.width == 0) return words;
  const int factor = fit_size({grid.crop.width, grid.crop.height}, kCropBox).width / grid.crop.width;
  return words + " Bottom: the outlined part of both" + (factor > 1 ? fmt::format(", {} times larger.", factor) : ".");
}

Stack make_legend(const Grid& grid, const std::optional<ColorScale>& errors) {
  Stack legend;
  if (errors)
    legend.push_back(make_color_bar(*errors, "error, visibility less area truth: blue too dark, red too bright"));
  const auto shows = [](const GridTile& tile) { return !tile.visibility.empty(); };
  if (std::ranges::any_of(grid.tiles, shows)) legend.push_back({"", explain_rows(grid, errors.has_value())});
  return legend;
}

// Small against any disagreement that can be seen, and enough to follow the edge where there is none.
constexpr double kVarianceFloor = 1e-9;
// Likewise small against any edge, and enough to follow the disagreement where there is none.
constexpr double kEdgeFloor = 1e-6;
constexpr int kTilesAcross = 16;  // of a picture

// Sums of all pixels above and left of each corner: any rectangle's sum is four look-ups.
class SummedArea {
 public:
  SummedArea(int width, int height)
      : stride_(static_cast<std::size_t>(width) + 1), sums_(stride_ * (static_cast<std::size_t>(height) + 1)) {}

  void set(int x, int y, double value) {
    const std::size_t i = index(x + 1, y + 1);
    sums_[i] = value + sums_[i - 1] + sums_[i - stride_] - sums_[i - stride_ - 1];
  }

  double mean(const Rect& r) const {
    const double sum = sums_[index(r.x + r.width, r.y + r.height)] - sums_[index(r.x, r.y + r.height)] -
                       sums_[index(r.x + r.width, r.y)] + sums_[index(r.x, r.y)];
    return sum / (static_cast<double>(r.width) * r.height);
  }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x); }

  std::size_t stride_;
  std::vector<double> sums_;
};

// Quantised, so that sums are exact and equal rectangles tie wherever they lie.
double quantise(double value) { return std::nearbyint(value * 1048576.0) / 1048576.0; }

double variance_at(const std::vector<const Image*>& images, int x, int y) {
  double sum = 0.0;
  double squares = 0.0;
  for (const Image* image : images) {
    const auto value = static_cast<double>(*image->at(x, y));
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(images.size());
  const double variance = squares / count - (sum / count) * (sum / count);
  return std::isfinite(variance) ? quantise(std::max(0.0, variance)) : 0.0;
}

double reference_at(const Image& reference, int x, int y) {
  const auto value = static_cast<double>(*reference.at(x, y));
  return std::isfinite(value) ? quantise(std::clamp(value, 0.0, 1.0)) : 0.0;
}

// The rectangle of `size` in the image with the largest score.
Rect find_best(const Image& image, Size size, const auto& score_of) {
  size = {std::min(size.width, image.width), std::min(size.height, image.height)};
  Rect best{0, 0, size.width, size.height};
  double best_score = -1.0;
  for (int y = 0; y + size.height <= image.height; ++y) {
    for (int x = 0; x + size.width <= image.width; ++x) {
      const Rect here{x, y, size.width, size.height};
      const double score = score_of(here);
      if (score > best_score) {
        best_score = score;
        best = here;
      }
    }
  }
  return best;
}

}  // namespace

Figure make_figure(const Grid& grid) {
  const std::optional<ColorScale> errors = choose_error_colors(grid);
  Figure figure{grid.title, grid.subtitle, {}, grid.columns, make_legend(grid, errors)};
  figure.stacks.resize(grid.tiles.size());
  tbb::parallel_for(std::size_t{0}, grid.tiles.size(),
                    [&](std::size_t i) { figure.stacks[i] = make_stack(grid.tiles[i], grid, errors); });
  return figure;
}

void write_grid(const std::filesystem::path& path, const Grid& grid) { write_figure(path, make_figure(grid)); }

Size choose_crop_size(Size picture) {
  const int width = std::clamp(picture.width / 4, 1, 45);
  return {width, std::clamp(width * 3 / 4, 1, std::max(1, picture.height))};
}

Rect find_disputed_edge(const std::vector<const Image*>& visibility, std::size_t reference, Size size) {
  std::vector<const Image*> images;
  std::copy_if(visibility.begin(), visibility.end(), std::back_inserter(images),
               [](const Image* image) { return image != nullptr && !image->empty(); });
  if (images.empty()) return {};
  const bool has_reference =
      reference < visibility.size() && visibility[reference] != nullptr && !visibility[reference]->empty();
  const Image& edge = has_reference ? *visibility[reference] : *images.front();
  SummedArea variance(edge.width, edge.height);
  SummedArea lit(edge.width, edge.height);
  for (int y = 0; y < edge.height; ++y) {
    for (int x = 0; x < edge.width; ++x) {
      variance.set(x, y, variance_at(images, x, y));
      lit.set(x, y, reference_at(edge, x, y));
    }
  }
  return find_best(edge, size, [&](const Rect& here) {
    const double m = lit.mean(here);
    return (variance.mean(here) + kVarianceFloor) * (4.0 * m * (1.0 - m) + kEdgeFloor);
  });
}

Rect find_largest_tile(const Image& values) {
  SummedArea sums(values.width, values.height);
  for (int y = 0; y < values.height; ++y)
    for (int x = 0; x < values.width; ++x) sums.set(x, y, reference_at(values, x, y));
  const int side = std::max(1, values.width / kTilesAcross);
  return find_best(values, {side, side}, [&](const Rect& here) { return sums.mean(here); });
}

}  // namespace shadowbench::images
