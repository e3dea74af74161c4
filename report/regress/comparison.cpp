#include "report/regress/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/records/format.h"

namespace shadowbench::regress {
namespace {

using records::format_number;
using records::format_ratio;

/// Notes what a test finds to be more than noise: `what` says so of many, and `one` of them, in so many columns, is the
/// least likely.
void add_noise(Comparison& comparison, const metrics::PixelTest& test, const char* what, const char* one, int columns) {
  if (test.beyond == 0) return;
  const auto x = test.worst % static_cast<std::size_t>(columns), y = test.worst / static_cast<std::size_t>(columns);
  comparison.add(
      Outcome::kChanged,
      {.metric = kLevel,
       .actual = test.smallest_p,
       .limit = test.corrected_level,
       .text = fmt::format("{} of {} {}; the least likely is {} ({}, {}), p = {:.2g} (corrected level "
                           "{:.2g})",
                           test.beyond, test.tested, what, one, x, y, test.smallest_p, test.corrected_level)});
}

/// Compares one cell, finding by finding.
class CellComparer {
 public:
  CellComparer(const ActualCell& actual, const BaselineCell& expected, const CellImages& images,
               const Tolerances& tolerances)
      : actual_(actual),
        expected_(expected),
        images_(images),
        tolerances_(tolerances),
        result_(name_comparison(actual.record)) {}

  Comparison compare() {
    compare_images();
    const ComparedValues values = read_values(actual_.record);
    for (const metrics::Metric& metric : list_compared_metrics()) compare_number(metric, values);
    compare_ratios(values);
    return std::move(result_);
  }

 private:
  const ActualCell& actual_;
  const BaselineCell& expected_;
  const CellImages& images_;
  const Tolerances& tolerances_;
  Comparison result_;

  const Tolerance& tolerance(const std::string& metric) const { return tolerances_.find(expected_.filter, metric); }
  bool has_spread() const { return !images_.uncertainty.seed_mean.empty(); }
  bool same_seed() const { return actual_.origin.seed == expected_.origin.seed; }
  double expected_number(const char* path, double otherwise) const {
    const auto found = expected_.values.numbers.find(path);
    return found == expected_.values.numbers.end() ? otherwise : found->second;
  }

  void add_missing(const std::string& path, double before, const std::string& written, double limit) {
    result_.add(Outcome::kChanged, {.metric = path,
                                    .expected = before,
                                    .limit = limit,
                                    .text = fmt::format("{} was {}, and is missing: {}", path, written,
                                                        find_absence(actual_.record, path))});
  }

  void compare_images() {
    if (has_spread() && !same_seed()) {
      compare_spread();
      return;
    }
    result_.pixels = compare_pixels(actual_.images, images_, tolerance(kPixel).limit);
    const PixelChange& change = *result_.pixels;
    const std::string largest = fmt::format("the largest difference is {} at pixel ({}, {})", format_number(change.max),
                                            change.max_x, change.max_y);
    limit(kShare, change.share(),
          fmt::format("{} of {} pixels differ by more than {} and what rounding explains; {}", change.changed,
                      change.compared, format_number(tolerance(kPixel).limit), largest));
    limit(kLargest, change.max, largest);
    limit(kMean, change.mean, fmt::format("the mean difference is {}", format_number(change.mean)));
    const double pixels = static_cast<double>(std::max<std::int64_t>(change.pixels(), 1));
    const std::int64_t excused = change.excused_flips + change.excused_rounding;
    limit(kExcused, static_cast<double>(excused - change.excused_expected) / pixels,
          fmt::format("{} pixels are excused, {} in the baseline alone", excused, change.excused_expected));
    limit(kExcusedChanged, static_cast<double>(change.excused_changed) / pixels,
          fmt::format("{} excused pixels differ", change.excused_changed));
    if (change.excused_changed > 0) {
      result_.notes.push_back(
          fmt::format("{} excused pixels differ: a comparison may flip at {} pixels, rounding moves {} by 1/32 or more",
                      change.excused_changed, change.excused_flips, change.excused_rounding));
    }
  }

  void limit(const char* metric, double value, const std::string& text) {
    const Tolerance& allowed = tolerance(metric);
    if (value <= allowed.limit) return;
    result_.add(Outcome::kChanged, {.metric = metric,
                                    .actual = value,
                                    .limit = allowed.limit,
                                    .text = fmt::format("{} (limit {})", text, format_number(allowed.limit))});
  }

  void compare_spread() {
    const double lookups = std::max(expected_number("cost.fetches", 1.0), 1.0);
    const double level = tolerance(kLevel).limit;
    const SpreadTest test = test_spread(actual_.images.visibility, images_.uncertainty, lookups, level);
    result_.notes.push_back(fmt::format("drawn with seed {}, the baseline with {}: tested as noise, at level {}",
                                        actual_.origin.seed, expected_.origin.seed, format_number(level)));
    const int width = actual_.images.visibility.width;
    add_noise(result_, test.pixels, "pixels are not explained by the filter's noise", "pixel", width);
    add_noise(result_, test.blocks, "blocks of 8 x 8 pixels are not explained by the filter's noise", "block",
              (width + 7) / 8);
  }

  void compare_number(const metrics::Metric& metric, const ComparedValues& values) {
    const std::string path(metric.path);
    const Tolerance& allowed = tolerance(path);
    if (std::isinf(allowed.limit)) return;
    const auto before = expected_.values.numbers.find(path);
    const auto now = values.numbers.find(path);
    if (before == expected_.values.numbers.end()) {
      if (now == values.numbers.end()) return;
      result_.add(Outcome::kChanged,
                  {.metric = path,
                   .actual = now->second,
                   .limit = allowed.limit,
                   .text = fmt::format("{} is {}, and missing in the baseline", path, format_number(now->second))});
      return;
    }
    if (now == values.numbers.end())
      return add_missing(path, before->second, format_number(before->second), allowed.limit);
    compare_values(metric, before->second, now->second, allowed);
  }

  void compare_values(const metrics::Metric& metric, double before, double now, const Tolerance& allowed) {
    if (metric.baseline == metrics::MetricBaseline::kRate && has_spread() && !same_seed()) {
      result_.notes.push_back(fmt::format("{} is not compared with that of another seed: {}, was {}", metric.path,
                                          format_number(now), format_number(before)));
      return;
    }
    const bool error = is_error(metric);
    const double limit = allowed.limit + (error ? explained_change() : 0.0);
    if (std::abs(now - before) <= limit) return;
    const bool worse = error && std::abs(now) > std::abs(before);
    const char* kind = worse ? "less accurate" : error ? "more accurate" : "changed";
    // A part of an error may grow while the error itself does not: it says why an image is wrong, not how much.
    const bool regression = worse && !metric.path.starts_with("attribution.");
    result_.add(regression ? Outcome::kLessAccurate : Outcome::kChanged,
                {.metric = std::string(metric.path),
                 .expected = before,
                 .actual = now,
                 .limit = limit,
                 .text = fmt::format("{}: {}, was {} ({}; limit {}: {})", metric.path, format_number(now),
                                     format_number(before), kind, format_number(limit), allowed.reason)});
  }

  /// How far excused pixels and the noise of truth and filter may move a mean of errors. The truth of one seed is the
  /// same, except that another machine's instructions may move its rays.
  double explained_change() const {
    const double receivers = std::max(expected_number("receivers", 0.0), 1.0);
    const double excused = result_.pixels ? std::sqrt(result_.pixels->excused_squares / receivers) : 0.0;
    const double noise =
        same_seed() && actual_.origin.machine == expected_.origin.machine
            ? 0.0
            : 3.0 * std::hypot(expected_number("truth.se", 0.0), actual_.record.truth.se.value_or(0.0));
    return excused + noise + (has_spread() && !same_seed() ? spread_of_errors(receivers) : 0.0);
  }

  /// Three standard deviations of the root mean square error over seeds, to first order: its derivative by
  /// pixel i is e_i / (n RMSE), and |e_i| is at most 1.
  double spread_of_errors(double receivers) const {
    double squares = 0.0;
    for (const float deviation : images_.uncertainty.seed_deviation.texels)
      squares += static_cast<double>(deviation) * static_cast<double>(deviation);
    return 3.0 * std::sqrt(squares) / (receivers * std::clamp(expected_number("error.rmse", 1.0), 1e-3, 1.0));
  }

  void compare_ratios(const ComparedValues& values) {
    if (expected_.values.ratios.empty()) {
      if (!values.ratios.empty()) result_.notes.push_back("times are not compared: the baseline has none");
      return;
    }
    if (actual_.origin.machine != expected_.origin.machine || actual_.origin.renderer != expected_.origin.renderer) {
      result_.notes.push_back(fmt::format("times are not compared: the baseline is of {} on {}",
                                          expected_.origin.renderer, expected_.origin.machine));
      return;
    }
    for (const auto& [path, before] : expected_.values.ratios) {
      const Tolerance& allowed = tolerance(path);
      const auto now = values.ratios.find(path);
      if (std::isinf(allowed.limit)) continue;
      if (now == values.ratios.end()) {
        add_missing(path, before.median, format_ratio(before), allowed.limit);
      } else if (now->second.ci95.low > before.ci95.high * (1.0 + allowed.limit)) {
        result_.add(
            Outcome::kSlower,
            {.metric = path,
             .expected = before.median,
             .actual = now->second.median,
             .limit = allowed.limit,
             .text = fmt::format("{}: {}, was {}: slower by more than {} of the interval's end", path,
                                 format_ratio(now->second), format_ratio(before), format_number(allowed.limit))});
      }
    }
  }
};

std::string describe_cell(const std::string& view, int map_size, int width, int height) {
  return fmt::format("view {}, map {}, {} x {}", view, map_size, width, height);
}

bool same_size(const images::Image& a, const images::Image& b) { return a.width == b.width && a.height == b.height; }

/// Why two images cannot be compared pixel by pixel; empty where they can.
std::string find_mismatch(const images::Image& actual, const images::Image& expected) {
  if (expected.empty()) return "the baseline has no image of it";
  if (actual.empty()) return "the run has no image of it";
  if (same_size(actual, expected)) return "";
  return fmt::format("the image has {} x {} pixels, and {} x {} in the baseline", actual.width, actual.height,
                     expected.width, expected.height);
}

/// What is wrong with one cell's images; empty where nothing is.
std::string find_damage(const CellImages& images, const char* whose) {
  const images::UncertaintyImages& uncertainty = images.uncertainty;
  for (const images::UncertaintyImage& each : images::list_uncertainty_images()) {
    const images::Image& image = uncertainty.*each.image;
    if (!image.empty() && !same_size(image, images.visibility))
      return fmt::format("{} image '{}' has another size than its visibility", whose, each.id);
  }
  if (uncertainty.seed_mean.empty() != uncertainty.seed_deviation.empty())
    return fmt::format("{} images lack the mean or the deviation over seeds", whose);
  return "";
}

/// Why a cell cannot be compared; empty where it can.
std::string find_obstacle(const ActualCell& actual, const CellImages& expected) {
  if (!actual.unreadable.empty()) return actual.unreadable;
  for (const std::string& found : {find_mismatch(actual.images.visibility, expected.visibility),
                                   find_damage(actual.images, "the run's"), find_damage(expected, "the baseline's")})
    if (!found.empty()) return found;
  return "";
}

std::string find_obstacle(const TruthImages& actual, const TruthImages& expected) {
  for (const auto member : {&TruthImages::area, &TruthImages::standard_error}) {
    const std::string mismatch = find_mismatch(actual.*member, expected.*member);
    if (!mismatch.empty()) return mismatch;
  }
  return same_size(actual.area, actual.standard_error) ? "" : "the truth and its standard error have other sizes";
}

}  // namespace

std::string name_of(Outcome outcome) {
  constexpr const char* kNames[] = {"same",  "slower",  "changed",    "less accurate",
                                    "extra", "missing", "unreadable", "broken"};
  return kNames[static_cast<std::size_t>(outcome)];
}

void Comparison::add(Outcome worse, Finding finding) {
  outcome = std::max(outcome, worse);
  findings.push_back(std::move(finding));
}

Comparison name_comparison(const records::CellRecord& record) {
  Comparison comparison{name_cell(record), describe_cell(record.view, record.map_size, record.width, record.height)};
  comparison.measured_s = record.measured_s;
  return comparison;
}

Comparison name_truth(const records::CellRecord& record) {
  return {{truth_key(record), record.scene, record.view, kTruthName, kTruthName},
          fmt::format("view {}, {} x {}", record.view, record.width, record.height)};
}

Comparison name_comparison(const BaselineCell& cell) {
  return {cell, describe_cell(cell.view, cell.map_size, cell.width, cell.height)};
}

Comparison compare_cell(const ActualCell& actual, const BaselineCell& expected, const CellImages& expected_images,
                        const Tolerances& tolerances) {
  const std::string obstacle = find_obstacle(actual, expected_images);
  if (obstacle.empty()) return CellComparer(actual, expected, expected_images, tolerances).compare();
  Comparison comparison = name_comparison(actual.record);
  comparison.add(Outcome::kUnreadable, obstacle);
  return comparison;
}

Comparison compare_truth(const ActualTruth& actual, const TruthImages& expected, double level) {
  Comparison comparison = name_truth(actual.record);
  if (const std::string obstacle = find_obstacle(actual.images, expected); !obstacle.empty()) {
    comparison.add(Outcome::kUnreadable, obstacle);
    return comparison;
  }
  const metrics::PixelTest test = test_truth(actual.images, expected, level);
  add_noise(comparison, test, "pixels of the truth differ by more than its standard errors explain", "pixel",
            actual.images.area.width);
  return comparison;
}

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
