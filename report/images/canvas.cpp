#include "report/images/canvas.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace shadowbench::images {
namespace {

Image magnify_image(const Image& image, Size size) {
  Image result(size.width, size.height, image.channels);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      std::copy_n(image.at(x * image.width / size.width, y * image.height / size.height), image.channels,
                  result.at(x, y));
  return result;
}

/// How much of each source pixel one of the result covers, from the first of them on.
struct Cover {
  int begin = 0;
  std::vector<float> weights;  ///< their sum is 1
};

std::vector<Cover> list_covers(int from, int to) {
  std::vector<Cover> covers(static_cast<std::size_t>(to));
  for (int at = 0; at < to; ++at) {
    const double step = static_cast<double>(from) / to, first = at * step, last = std::min<double>(from, first + step);
    Cover& cover = covers[static_cast<std::size_t>(at)];
    cover.begin = static_cast<int>(first);
    for (int i = cover.begin; i < last; ++i)
      cover.weights.push_back(static_cast<float>((std::min(last, i + 1.0) - std::max(first, i + 0.0)) / step));
  }
  return covers;
}

// A mean over the area has no negative lobes, so no bright seams beside a shadow's edge that no filter made.
Image reduce_image(const Image& image, Size size) {
  Image result(size.width, size.height, image.channels);
  float* to = result.texels.data();
  const std::vector<Cover> columns = list_covers(image.width, size.width);
  for (const Cover& rows : list_covers(image.height, size.height)) {
    for (const Cover& column : columns) {
      for (std::size_t v = 0; v < rows.weights.size(); ++v) {
        const float* from = image.at(column.begin, rows.begin + static_cast<int>(v));
        for (const float weight : column.weights)
          for (int c = 0; c < image.channels; ++c) to[c] += rows.weights[v] * weight * *from++;
      }
      to += image.channels;
    }
  }
  return result;
}

}  // namespace

void fill_rect(Image& canvas, const Rect& rect, const Rgb& color) {
  for (int y = std::max(0, rect.y); y < std::min(canvas.height, rect.y + rect.height); ++y)
    for (int x = std::max(0, rect.x); x < std::min(canvas.width, rect.x + rect.width); ++x)
      std::copy(color.begin(), color.end(), canvas.at(x, y));
}

void outline_rect(Image& canvas, const Rect& r, int width, const Rgb& color) {
  const int outer = r.width + 2 * width;
  fill_rect(canvas, {r.x - width, r.y - width, outer, width}, color);
  fill_rect(canvas, {r.x - width, r.y + r.height, outer, width}, color);
  fill_rect(canvas, {r.x - width, r.y, width, r.height}, color);
  fill_rect(canvas, {r.x + r.width, r.y, width, r.height}, color);
}

void paste_image(Image& canvas, const Image& picture, int x, int y) {
  assert(picture.channels == canvas.channels);
  const int left = std::max(0, -x), right = std::min(picture.width, canvas.width - x);
  for (int row = std::max(0, -y); left < right && row < std::min(picture.height, canvas.height - y); ++row)
    std::copy_n(picture.at(left, row), picture.channels * (right - left), canvas.at(x + left, y + row));
}

Image frame_image(const Image& picture, int width, const Rgb& color) {
  Image framed(picture.width + 2 * width, picture.height + 2 * width, 3);
  fill_rect(framed, {0, 0, framed.width, framed.height}, color);
  paste_image(framed, picture, width, width);
  return framed;
}

Image cut_image(const Image& image, const Rect& rect) {
  Image result(rect.width, rect.height, image.channels);
  for (int y = 0; y < rect.height; ++y)
    std::copy_n(image.at(rect.x, rect.y + y), rect.width * image.channels, result.at(0, y));
  return result;
}

Size fit_size(Size size, Size box) {
  if (size.width <= 0 || size.height <= 0) return {};
  const int factor = std::min(box.width / size.width, box.height / size.height);
  if (factor >= 1) return {size.width * factor, size.height * factor};
  const double scale =
      std::min(static_cast<double>(box.width) / size.width, static_cast<double>(box.height) / size.height);
  return {std::clamp(static_cast<int>(size.width * scale + 0.5), 1, box.width),
          std::clamp(static_cast<int>(size.height * scale + 0.5), 1, box.height)};
}

Image scale_image(const Image& image, Size size) {
  return size.width >= image.width ? magnify_image(image, size) : reduce_image(image, size);
}

Image fit_image(const Image& image, Size box) { return scale_image(image, fit_size({image.width, image.height}, box)); }

Image fit_worst(const Image& image, Size box, const Badness& badness) {
  const Size size = fit_size({image.width, image.height}, box);
  if (size.width >= image.width) return magnify_image(image, size);
  Image shown(size.width, size.height, 1);
  float* to = shown.texels.data();
  const std::vector<Cover> columns = list_covers(image.width, size.width);
  for (const Cover& rows : list_covers(image.height, size.height)) {
    for (const Cover& column : columns) {
      float worst = *image.at(column.begin, rows.begin);
      for (std::size_t v = 0; v < rows.weights.size(); ++v) {
        const float* row = image.at(column.begin, rows.begin + static_cast<int>(v));
        for (std::size_t u = 0; u < column.weights.size(); ++u)
          if (badness(row[u]) > badness(worst)) worst = row[u];
      }
      *to++ = worst;
    }
  }
  return shown;
}

}  // namespace shadowbench::images
