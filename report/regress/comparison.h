#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reference/metrics/error_stats.h"
#include "report/regress/baseline.h"

namespace shadowbench::regress {

/// How a cell stands to its baseline, the worst last.
enum class Outcome { kSame, kSlower, kChanged, kLessAccurate, kExtra, kMissing, kUnreadable, kBroken };

/// Names an outcome: "same", "slower", "changed", "less accurate", "extra", "missing", "unreadable", "broken" (a filter
/// whose file has a mistake, so that the run measured nothing).
std::string name_of(Outcome outcome);

/// One thing that is not as the baseline has it.
struct Finding {
  std::string metric = {};  ///< of list_limited_metrics(); empty where no limit is at stake
  std::optional<double> expected = {};
  std::optional<double> actual = {};
  std::optional<double> limit = {};
  std::string text;  ///< a whole sentence
};

/// What comparing one cell, or one view's truth, found.
struct Comparison : CellName {  // the filter is "truth" for a view's truth
  std::string settings;         ///< "view main, map 512, 256 x 144"
  Outcome outcome = Outcome::kSame;
  std::vector<Finding> findings = {};
  std::vector<std::string> notes = {};  ///< what was not compared, and why
  std::optional<PixelChange> pixels = {};
  std::optional<std::string> picture = {};  ///< below the folder of the comparison
  bool accepted = false;                    ///< what differs has become the baseline
  std::optional<double> measured_s = {};    ///< seconds that measuring the run's cell took

  bool differs() const { return outcome != Outcome::kSame; }
  bool failed() const { return differs() && !accepted; }
  /// Notes a finding; the worse outcome stays.
  void add(Outcome worse, Finding finding);
  void add(Outcome worse, std::string text) { add(worse, Finding{.text = std::move(text)}); }
};

/// One cell of the run at hand.
struct ActualCell {
  records::CellRecord record;
  Origin origin;
  CellImages images;       ///< empty where they cannot be read
  std::string unreadable;  ///< why
};

/// Compares a cell with its baseline; `expected` has the images of the cell.
/// Requires equal keys.
Comparison compare_cell(const ActualCell& actual, const BaselineCell& expected, const CellImages& expected_images,
                        const Tolerances& tolerances);

/// One view's truth of the run at hand.
struct ActualTruth {
  records::CellRecord record;  ///< of any cell of the view
  TruthImages images;
};

/// Compares truths by a test of noise at every pixel.
Comparison compare_truth(const ActualTruth& actual, const TruthImages& expected, double level);

/// Make a comparison that only has a name: of a cell, or of the truth of a cell's view.
Comparison name_truth(const records::CellRecord& record);
Comparison name_comparison(const records::CellRecord& record);
Comparison name_comparison(const BaselineCell& cell);

/// Tests whether a stochastic filter's image, drawn with a seed of its own, is one of those whose mean and deviation
/// the baseline keeps; pixel by pixel, and over blocks of 8 x 8 pixels, where a small shift adds up. `lookups` is how
/// many comparisons a receiver averages. The image's pixels, and lookups, are taken to be independent.
struct SpreadTest {
  metrics::PixelTest pixels;
  metrics::PixelTest blocks;
};
SpreadTest test_spread(const images::Image& image, const images::UncertaintyImages& expected, double lookups,
                       double level);

/// Tests two truths, each with its standard errors; where all rays of a truth agree, it has no such error, and may be
/// off by the limit of 3 in 64 rays.
metrics::PixelTest test_truth(const TruthImages& a, const TruthImages& b, double level);

}  // namespace shadowbench::regress
