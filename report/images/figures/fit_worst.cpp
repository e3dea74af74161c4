#include "report/images/figures/fit_worst.h"

#include <algorithm>
#include <cstdint>

namespace shadowbench::images {
namespace {

/// The source pixels that one of the result stands for: [begin, end).
struct Span {
  int begin;
  int end;
};

Span span_of(int at, int from, int to) {
  const auto scaled = [&](int place) { return static_cast<int>(static_cast<std::int64_t>(place) * from / to); };
  const int begin = scaled(at);
  return {begin, std::max(begin + 1, scaled(at + 1))};
}

}  // namespace

Image fit_worst(const Image& image, int width, const Badness& badness) {
  const int height = std::max(1, static_cast<int>(static_cast<std::int64_t>(image.height) * width / image.width));
  Image shown(width, height, 1);
  for (int y = 0; y < height; ++y) {
    const Span rows = span_of(y, image.height, height);
    for (int x = 0; x < width; ++x) {
      const Span columns = span_of(x, image.width, width);
      float worst = *image.at(columns.begin, rows.begin);
      for (int v = rows.begin; v < rows.end; ++v) {
        for (int u = columns.begin; u < columns.end; ++u)
          if (badness(*image.at(u, v)) > badness(worst)) worst = *image.at(u, v);
      }
      *shown.at(x, y) = worst;
    }
  }
  return shown;
}

}  // namespace shadowbench::images
