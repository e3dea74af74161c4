#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shadowbench::metrics {

/// How far an image is from the truth, over the pixels of a mask.
struct ErrorStats {
  std::int64_t count = 0;       ///< pixels that were compared
  std::int64_t not_finite = 0;  ///< pixels of the mask that were left out because the image is NaN or infinite there
  double rmse = 0.0;            ///< root mean square of image - truth
  double mae = 0.0;             ///< mean of |image - truth|
  double p95 = 0.0;             ///< 95th percentile of |image - truth|, nearest rank
  double max = 0.0;             ///< largest |image - truth|
  double mean = 0.0;            ///< signed: positive where the image is brighter than the truth
};

/// Compares an image with the truth where `mask` is not 0. Off the mean square the mean of `variance` is taken, the
/// truth's own as an estimate, which may be empty: what is left of it is without bias.
/// Requires spans of one length. Gives nothing where the mask holds no finite pixel.
std::optional<ErrorStats> measure_error(std::span<const float> image, std::span<const float> truth,
                                        std::span<const std::uint8_t> mask, std::span<const float> variance = {});

/// A mean with its 95 % confidence interval.
struct MeanInterval {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// How many standard errors of a mean of `count` values are the half-width of its 95 % interval: Student's t, at 97 %
/// because means over few places of a map's grid are not normal (reference/README.md has what was measured). Requires
/// two values or more. `below` is the share of errors below the upper end.
double find_student_t(std::size_t count, double below = 0.985);

/// The standard error of the mean of independent values, from their spread. Requires two values or more.
double find_standard_error(std::span<const double> values);

/// The mean of independent values with its 95 % confidence interval by find_student_t(). Nothing for fewer than two
/// values.
std::optional<MeanInterval> find_mean_interval(std::span<const double> values);

/// The stations between a filter's image and the truth, one value per pixel each; 1 lit, 0 blocked.
struct AttributionStations {
  std::span<const float> image;        ///< as the GPU made it
  std::span<const double> model;       ///< the filter in double precision, on the same map; may be empty
  std::span<const double> closer;      ///< brute-force percentage-closer filter with the filter's own kernel and depth
  std::span<const float> kernel;       ///< ray-traced continuous kernel: an ideal map and an ideal bias
  std::span<const float> area;         ///< ray-traced visibility of the real light
  std::span<const std::uint8_t> mask;  ///< 0: the pixel does not count
  std::span<const float> kernel_variance = {};  ///< of `kernel` as an estimate; may be empty
};

/// The parts of an error, in the order in which they add up.
enum class ErrorPart { kNumeric, kEstimator, kDiscretisation, kModel };
inline constexpr std::size_t kErrorParts = 4;

/// How much of the error one part is.
struct PartStats {
  /// Root mean square of the part alone; those of several parts do not add. The variance of `kernel` is taken off the
  /// mean square of the two parts that it is in.
  double rms = 0.0;
  double share = 0.0;  ///< mean(e * part) / mean(e^2), e the whole error: shares add up to 1, and may be negative
};

/// An error as the sum of four signed parts.
struct Attribution {
  std::array<std::vector<float>, kErrorParts>
      parts;  ///< per pixel, 0 where a pixel does not count; empty: there is none
  std::array<std::optional<PartStats>, kErrorParts> stats;  ///< a share is absent where there is no error at all
  std::int64_t not_finite = 0;                              ///< pixels of the mask that are left out
};

/// Splits image - area into (image - model) + (model - closer) + (closer - kernel) + (kernel - area).
/// Without a model the first part does not exist, and the second is image - closer, which includes it.
/// Requires spans of one length.
Attribution attribute_error(const AttributionStations& stations);

/// How much images of the same receivers differ that are independent of each other.
struct Change {
  double value = 0.0;                ///< root mean square over receivers and pairs of images
  std::optional<double> reach = {};  ///< half-width of its 95 % interval, by the jackknife; none for two groups
};

/// How much visibility changes between frames that are independent of each other, where the truth has none. Every
/// `group` images that follow each other are no such frames, being chosen to differ: only pairs of two groups count, so
/// that the result does not depend on how large the groups are. `mask` is not 0 where a pixel counts; a receiver that
/// is not finite in one image is left out. Nothing for fewer than two groups or where no receiver is left. Source: the
/// mean over pairs is Hoeffding's U-statistic; its interval is Arvesen's (1969, Jackknifing U-Statistics, Annals of
/// Mathematical Statistics 40(6)).
std::optional<Change> measure_change(std::span<const std::span<const float>> images, std::size_t group,
                                     std::span<const std::uint8_t> mask);

/// The difference of two measurements of one pixel, and how much chance may contribute to it.
struct NoisyDifference {
  double difference = 0.0;
  double variance = 0.0;            ///< variance of the difference; 0: the two must be equal
  double degrees_of_freedom = 1.0;  ///< degrees of freedom of the variance's estimate
};

/// The probability, two-sided, of such a difference or a larger one by chance; 0 for one that is not finite.
/// Source: Student 1908, The Probable Error of a Mean.
double find_p(const NoisyDifference& difference);

/// Adds differences that are independent of each other; the degrees of freedom of the sum's variance follow
/// Satterthwaite 1946, An Approximate Distribution of Estimates of Variance Components.
NoisyDifference add_differences(std::span<const NoisyDifference> differences);

/// How many lookups were lit, out of how many.
struct Share {
  double lit = 0.0;
  double lookups = 0.0;
};

/// The two-sided probability that two shares differ at least so much where both come from one probability,
/// whatever that is: it is right for few lookups, and where nearly all agree. Counts are rounded to whole numbers.
/// Source: Fisher 1935, The Logic of Inductive Inference (the exact test), twice its one-sided value.
double find_p(const Share& a, const Share& b);

/// Whether chance explains the differences of many pixels.
struct PixelTest {
  std::int64_t tested = 0;
  std::int64_t beyond = 0;       ///< pixels that differ by more than chance explains at the corrected level
  std::size_t worst = 0;         ///< index of the least likely difference
  double smallest_p = 1.0;       ///< its probability, not corrected
  double corrected_level = 0.0;  ///< the level divided by the number of tests: a smaller probability is beyond chance
};

/// Tests every pixel's probability at `level`, corrected for their number: the probability that any is found where all
/// are chance is at most `level`. Source: Bonferroni's inequality.
PixelTest test_pixels(std::span<const double> probabilities, double level);

}  // namespace shadowbench::metrics
