#include "report/regress/noise_test.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shadowbench::regress {
namespace {

using metrics::NoisyDifference;

constexpr int kBlock = 8;
constexpr double kScrambles = 16.0;  ///< scrambles that a truth's standard error is estimated from (reference/truth)
constexpr double kUnanimousLimit = 3.0 / 64.0;
constexpr double kHalfVariance = 0x1p-22 / 12.0;  ///< variance of rounding to 16 bits below 1, in steps of 2^-11

/// A pixel, or several together, as two tests see it: by the deviation that was measured over seeds, and as lookups
/// that were counted. Few seeds do not tell the deviation of what hardly ever happens, and counts do not know of
/// lookups that agree.
struct Noise {
  NoisyDifference difference;
  metrics::Share drawn;
  metrics::Share expected;

  /// The larger probability: chance explains the pixel where either test says so.
  double p() const { return std::max(metrics::find_p(difference), metrics::find_p(drawn, expected)); }
};

std::vector<Noise> list_noise(const images::Image& image, const images::UncertaintyImages& expected, double lookups) {
  const double seeds = images::kSpreadSeeds;
  std::vector<Noise> noise(image.texels.size());
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double value = static_cast<double>(image.texels[i]), mean = static_cast<double>(expected.seed_mean.texels[i]);
    const double deviation = static_cast<double>(expected.seed_deviation.texels[i]);
    noise[i] = {{value - mean, deviation * deviation * (1.0 + 1.0 / seeds) + kHalfVariance, seeds - 1.0},
                {value * lookups, lookups},
                {mean * lookups * seeds, lookups * seeds}};
  }
  return noise;
}

Noise add(const std::vector<const Noise*>& parts) {
  Noise sum;
  std::vector<NoisyDifference> differences;
  for (const Noise* part : parts) {
    differences.push_back(part->difference);
    sum.drawn = {sum.drawn.lit + part->drawn.lit, sum.drawn.lookups + part->drawn.lookups};
    sum.expected = {sum.expected.lit + part->expected.lit, sum.expected.lookups + part->expected.lookups};
  }
  sum.difference = metrics::add_differences(differences);
  return sum;
}

std::vector<double> test_blocks(const std::vector<Noise>& pixels, int width, int height) {
  std::vector<double> probabilities;
  for (int top = 0; top < height; top += kBlock) {
    for (int left = 0; left < width; left += kBlock) {
      std::vector<const Noise*> block;
      for (int y = top; y < std::min(top + kBlock, height); ++y)
        for (int x = left; x < std::min(left + kBlock, width); ++x)
          block.push_back(&pixels[static_cast<std::size_t>(y * width + x)]);
      probabilities.push_back(add(block).p());
    }
  }
  return probabilities;
}

}  // namespace

SpreadTest test_spread(const images::Image& image, const images::UncertaintyImages& expected, double lookups,
                       double level) {
  const std::vector<Noise> pixels = list_noise(image, expected, lookups);
  std::vector<double> probabilities;
  for (const Noise& pixel : pixels) probabilities.push_back(pixel.p());
  // Two tests are made, at half the level each.
  return {metrics::test_pixels(probabilities, 0.5 * level),
          metrics::test_pixels(test_blocks(pixels, image.width, image.height), 0.5 * level)};
}

metrics::PixelTest test_truth(const TruthImages& a, const TruthImages& b, double level) {
  std::vector<double> probabilities(a.area.texels.size());
  for (std::size_t i = 0; i < probabilities.size(); ++i) {
    const double of_a = static_cast<double>(a.standard_error.texels[i]),
                 of_b = static_cast<double>(b.standard_error.texels[i]);
    double difference = static_cast<double>(a.area.texels[i]) - static_cast<double>(b.area.texels[i]);
    if (of_a == 0.0 || of_b == 0.0)
      difference = std::copysign(std::max(std::abs(difference) - kUnanimousLimit, 0.0), difference);
    probabilities[i] = metrics::find_p({difference, of_a * of_a + of_b * of_b + 2.0 * kHalfVariance, kScrambles - 1.0});
  }
  return metrics::test_pixels(probabilities, level);
}

}  // namespace shadowbench::regress
