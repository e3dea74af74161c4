#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace shadowbench::images {

/// A rectangle of pixels; empty where its width is 0.
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// A width and a height, in pixels.
struct Size {
  int width = 0;
  int height = 0;
};

/// A float picture: `channels` interleaved, rows top to bottom, no padding.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> texels;

  Image() = default;
  Image(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        texels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

  bool empty() const { return texels.empty(); }
  float* at(int x, int y) { return texels.data() + index(x, y); }
  const float* at(int x, int y) const { return texels.data() + index(x, y); }

 private:
  std::size_t index(int x, int y) const {
    assert(x >= 0 && y >= 0 && x < width && y < height);
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

/// Turns values, rows top to bottom, into an image of one channel.
template <class T>
Image make_image(int width, int height, const std::vector<T>& values) {
  Image image(width, height, 1);
  assert(values.size() == image.texels.size());
  std::copy(values.begin(), values.end(), image.texels.begin());
  return image;
}

}  // namespace shadowbench::images
