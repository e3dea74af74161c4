#include "report/images/crop.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace shadowbench::images {
namespace {

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
