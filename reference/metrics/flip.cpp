#include "reference/metrics/flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>

namespace shadowbench::metrics {
namespace {

using Plane = std::vector<double>;
using Color = glm::dvec3;

// Section 4.1.1: contrast sensitivity as sums of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct Gaussian {
  double a;
  double b;
};
constexpr Gaussian kAchromatic{1.0, 0.0047};
constexpr Gaussian kRedGreen{1.0, 0.0053};
constexpr Gaussian kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};

// Section 4.1.3: exponent of the colour difference, and where its upper part is compressed to.
constexpr double kColorExponent = 0.7;
constexpr double kKneePosition = 0.4;
constexpr double kKneeValue = 0.95;

// Section 4.2: width of features in degrees, and the exponent of their difference.
constexpr double kFeatureWidth = 0.082;
constexpr double kFeatureExponent = 0.5;

Color to_xyz(const Color& c) {
  return {0.4124564 * c.r + 0.3575761 * c.g + 0.1804375 * c.b, 0.2126729 * c.r + 0.7151522 * c.g + 0.0721750 * c.b,
          0.0193339 * c.r + 0.1191920 * c.g + 0.9503041 * c.b};
}

Color to_rgb(const Color& xyz) {
  static const glm::dmat3 from_rgb(to_xyz({1, 0, 0}), to_xyz({0, 1, 0}), to_xyz({0, 0, 1}));
  static const glm::dmat3 inverse = glm::inverse(from_rgb);
  return inverse * xyz;
}

Color white() { return to_xyz({1.0, 1.0, 1.0}); }

/// Linear opponent colours: luminance, red-green, blue-yellow.
Color to_opponent(const Color& rgb) {
  const Color r = to_xyz(rgb) / white();
  return {116.0 * r.y - 16.0, 500.0 * (r.x - r.y), 200.0 * (r.y - r.z)};
}

Color from_opponent(const Color& o) {
  const double y = (o.x + 16.0) / 116.0;
  return to_rgb(Color(y + o.y / 500.0, y, y - o.z / 200.0) * white());
}

double lab_root(double t) {
  constexpr double kDelta = 6.0 / 29.0;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

/// CIELAB with its chroma scaled by lightness: the Hunt effect.
Color to_hunt_lab(const Color& rgb) {
  const Color r = to_xyz(rgb) / white();
  const double y = lab_root(r.y), lightness = 116.0 * y - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (lab_root(r.x) - y), 0.01 * lightness * 200.0 * (y - lab_root(r.z))};
}

/// Abasi, Tehran and Fairchild 2019: city block in lightness, Euclid in chroma.
double hyab(const Color& a, const Color& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

double compress_color_difference(double difference) {
  static const double largest = std::pow(hyab(to_hunt_lab({0, 1, 0}), to_hunt_lab({0, 0, 1})), kColorExponent);
  const double knee = kKneePosition * largest, value = std::pow(difference, kColorExponent);
  if (value < knee) return kKneeValue / knee * value;
  return kKneeValue + (value - knee) / (largest - knee) * (1.0 - kKneeValue);
}

/// A filter of one dimension, its middle at the middle of the weights.
using Weights = std::vector<double>;

Weights sample_weights(int radius, const std::function<double(double)>& value) {
  Weights weights;
  for (int i = -radius; i <= radius; ++i) weights.push_back(value(i));
  return weights;
}

/// Adds weight times one row of a plane to another; compilers make vectors of it.
void add_row(double* sum, const double* row, double weight, int width) {
  for (int x = 0; x < width; ++x) sum[x] += weight * row[x];
}

Plane filter_rows(const Plane& plane, int width, int height, const Weights& weights) {
  Plane result(plane.size(), 0.0);
  const int taps = static_cast<int>(weights.size()), radius = taps / 2;
  Plane padded(static_cast<std::size_t>(width + 2 * radius));
  for (int y = 0; y < height; ++y) {
    const double* row = plane.data() + static_cast<std::ptrdiff_t>(y) * width;
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + width, radius, row[width - 1]);
    for (int i = 0; i < taps; ++i) {
      add_row(result.data() + static_cast<std::ptrdiff_t>(y) * width, padded.data() + i,
              weights[static_cast<std::size_t>(i)], width);
    }
  }
  return result;
}

Plane filter_columns(const Plane& plane, int width, int height, const Weights& weights) {
  Plane result(plane.size(), 0.0);
  const int taps = static_cast<int>(weights.size()), radius = taps / 2;
  for (int y = 0; y < height; ++y) {
    for (int i = 0; i < taps; ++i) {
      const std::ptrdiff_t from = std::clamp(y + i - radius, 0, height - 1);
      add_row(result.data() + static_cast<std::ptrdiff_t>(y) * width, plane.data() + from * width,
              weights[static_cast<std::size_t>(i)], width);
    }
  }
  return result;
}

Plane filter_both(const Plane& plane, int width, int height, const Weights& along_x, const Weights& along_y) {
  return filter_columns(filter_rows(plane, width, height, along_x), width, height, along_y);
}

/// Blurs a channel with a sum of Gaussians that weighs 1 in all.
Plane blur_channel(const Plane& plane, int width, int height, const std::vector<Gaussian>& sum, double ppd) {
  const double widest = kBlueYellow[0].b;  // the paper takes one radius for all channels
  const int radius =
      static_cast<int>(std::ceil(3.0 * std::sqrt(widest / (2.0 * std::numbers::pi * std::numbers::pi)) * ppd));
  Plane result(plane.size(), 0.0);
  double total = 0.0;
  for (const Gaussian& gaussian : sum) {
    const Weights weights = sample_weights(radius, [&](double i) {
      const double degrees = i / ppd;
      return std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / gaussian.b);
    });
    double mass = 0.0;
    for (const double weight : weights) mass += weight;
    // In two dimensions the factor stands once, the exponential once per axis.
    const double factor = gaussian.a * std::sqrt(std::numbers::pi / gaussian.b);
    total += factor * mass * mass;
    const Plane blurred = filter_both(plane, width, height, weights, weights);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += factor * blurred[i];
  }
  for (double& value : result) value /= total;
  return result;
}

std::vector<Color> perceive(const LinearPicture& picture, double ppd) {
  Plane channels[3];
  for (const glm::vec3& pixel : picture.pixels) {
    const Color opponent = to_opponent(Color(pixel));
    for (int c = 0; c < 3; ++c) channels[c].push_back(opponent[c]);
  }
  const std::vector<Gaussian> sums[] = {{kAchromatic}, {kRedGreen}, {kBlueYellow[0], kBlueYellow[1]}};
  for (int c = 0; c < 3; ++c) channels[c] = blur_channel(channels[c], picture.width, picture.height, sums[c], ppd);
  std::vector<Color> seen;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const Color rgb = from_opponent({channels[0][i], channels[1][i], channels[2][i]});
    seen.push_back(to_hunt_lab(glm::clamp(rgb, 0.0, 1.0)));
  }
  return seen;
}

/// Scales the positive weights to sum to 1 and the negative ones to -1.
Weights balance(Weights weights) {
  double positive = 0.0, negative = 0.0;
  for (const double weight : weights) (weight > 0.0 ? positive : negative) += std::abs(weight);
  for (double& weight : weights) weight /= weight > 0.0 ? positive : negative > 0.0 ? negative : 1.0;
  return weights;
}

/// Strength of edges (first derivative) or points (second) in the luminance of a picture.
Plane detect_features(const LinearPicture& picture, double ppd, int derivative) {
  Plane luminance;
  for (const glm::vec3& pixel : picture.pixels) luminance.push_back((to_opponent(Color(pixel)).x + 16.0) / 116.0);
  const double deviation = 0.5 * kFeatureWidth * ppd;
  const int radius = static_cast<int>(std::ceil(3.0 * deviation));
  const auto gaussian = [&](double i) { return std::exp(-0.5 * i * i / (deviation * deviation)); };
  const Weights across = balance(sample_weights(radius, gaussian));
  const Weights along = balance(sample_weights(
      radius, [&](double i) { return gaussian(i) * (derivative == 1 ? -i : i * i / (deviation * deviation) - 1.0); }));
  const Plane x = filter_both(luminance, picture.width, picture.height, along, across);
  const Plane y = filter_both(luminance, picture.width, picture.height, across, along);
  Plane strength(luminance.size());
  for (std::size_t i = 0; i < strength.size(); ++i) strength[i] = std::hypot(x[i], y[i]);
  return strength;
}

}  // namespace

FlipView view_for_flip(const LinearPicture& picture, double ppd) {
  return {picture.width, picture.height, perceive(picture, ppd), detect_features(picture, ppd, 1),
          detect_features(picture, ppd, 2)};
}

std::vector<float> measure_flip(const FlipView& a, const FlipView& b) {
  assert(a.width == b.width && a.height == b.height);
  std::vector<float> flip;
  flip.reserve(a.colors.size());
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    const double color = compress_color_difference(hyab(a.colors[i], b.colors[i]));
    const double feature = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    const double weight = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
    flip.push_back(static_cast<float>(std::clamp(std::pow(color, 1.0 - weight), 0.0, 1.0)));
  }
  return flip;
}

}  // namespace shadowbench::metrics
