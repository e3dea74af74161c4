#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

/// Version of stress.json.
inline constexpr int kStressSchemaVersion = 1;

/// The verdict on a filter at one value of a stress axis; each is worse than the one before.
enum class StressVerdict {
  kOk,
  kDegraded,  ///< the error is larger than the axis' bound
  kBroken     ///< NaN, infinity, all lit, all dark, or falling where the filter must rise
};
constexpr auto names_of(StressVerdict) { return std::array{"ok", "degraded", "broken"}; }

/// What kind of law a theoretical limit follows, and so how near a measurement has to come.
enum class StressTheoryKind {
  kOverflow,  ///< a number leaves its format: within 10 %
  kQuantum,   ///< a step of a format: within 10 %
  kSlope,     ///< geometry: within 10 %
  kRounding   ///< a bound on accumulated rounding: within a factor of 8
};
constexpr auto names_of(StressTheoryKind) { return std::array{"overflow", "quantum", "slope", "rounding"}; }

/// How a measured limit compares with its theory.
enum class StressAgreement {
  kAgrees,
  kExplained,  ///< it does not agree, and the axis says why
  kDisagrees
};
constexpr auto names_of(StressAgreement) { return std::array{"agrees", "explained", "disagrees"}; }

/// The range of an axis, with both ends.
using StressRange = Interval;

/// One observation.
struct StressSample {
  double value = 0.0;  ///< value of the axis' quantity
  StressVerdict verdict = StressVerdict::kOk;
  std::optional<double> measured;  ///< the axis' measure; empty: it is not finite, or there was nothing to measure
  std::string why;                 ///< what decided the verdict
};

/// The first place on an axis with a verdict.
struct StressOnset {
  double value = 0.0;                 ///< the first value with that verdict or a worse one
  std::optional<double> last_before;  ///< the last value without it; empty: the range begins with the verdict
  std::string why;                    ///< what decided the verdict at `value`
};

/// A limit that is known before anything is measured.
struct StressTheory {
  std::optional<double> onset;  ///< value of the axis; empty: theory says that there is none
  StressTheoryKind kind = StressTheoryKind::kOverflow;
  std::string formula;                              ///< with its numbers: "ln(65504) / 1 = 11.09"
  std::string source;                               ///< author, year, title, equation; or "derived"
  StressVerdict predicts = StressVerdict::kBroken;  ///< the verdict that the case reaches at `onset`
};

/// A theoretical limit of a case, and the measured one beside it.
struct StressLimit : StressTheory {
  std::optional<double> measured;  ///< the first value with that verdict; empty: none in the range
  std::optional<double> ratio;     ///< measured / onset; empty where one of the two is empty
  StressAgreement agreement = StressAgreement::kAgrees;
  std::string explanation;  ///< why the two do not agree, for kExplained
};

/// One filter in one variant on one axis.
struct StressCase {
  std::string filter;  ///< id; empty: the axis tests arithmetic that no filter has yet
  std::string variant;
  std::string level;  ///< what was tested: "GL", "model" or "arithmetic"
  ParamMap params;
  std::string not_available;          ///< why nothing was measured; empty: it was
  std::vector<StressSample> samples;  ///< all observations, by ascending value
  std::optional<StressOnset> degraded;
  std::optional<StressOnset> broken;
  std::vector<StressLimit> limits;
  std::vector<std::string> notes;  ///< verdicts that got better again
};

/// What is said of an axis before anything is measured.
struct StressAxisText {
  std::string id;  ///< the name of its file
  std::string title;
  std::string quantity;  ///< "exponent c"
  std::string unit;      ///< empty: a pure number
  bool log = true;       ///< how the axis is sampled, and values are drawn; else linear
  StressRange range;

  std::string measured;       ///< what samples measure: "largest error of visibility"
  std::string measured_unit;  ///< empty: a pure number
  double bound = 0.0;         ///< a measured value above it is `degraded`
  std::string broken_when;    ///< in words: "infinities in the map; NaN, all lit or all dark"
};

/// One axis with all its cases.
struct StressAxis : StressAxisText {
  std::vector<StressCase> cases;
};

/// Everything that `shadowbench stress` found.
struct StressRecord {
  std::string commit;
  GlRecord gl;
  MachineRecord machine;
  std::uint64_t seed = 0;
  std::vector<std::string> command;  ///< one entry per argument
  double seconds = 0.0;              ///< wall time
  std::vector<std::string> filters;  ///< labels of what was chosen
  std::vector<StressAxis> axes;
};

/// Names a case: "esm: r16f, linear (GL)".
std::string label_of(const StressCase& item);

/// The factor by which measured and theory may differ for a kind: 1.1 or 8.
double tolerance_of(StressTheoryKind kind);

/// Finds the first place where a case has `verdict` or a worse one; null: there is none in the range.
const StressOnset* find_onset(const StressCase& item, StressVerdict verdict);

/// Counts the limits that disagree with no explanation.
int count_disagreements(const StressRecord& record);

/// Makes the text of a stress.json: `gl` and `machine` as in results.json; a value that does not exist is null.
std::string make_stress_json(const StressRecord& record);

/// Makes stress.csv (RFC 4180): one row per observation, and one per case that was not available; what does not exist
/// is empty.
std::string make_stress_csv(const StressRecord& record);

}  // namespace shadowbench::records
