#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/context/context.h"
#include "harness/options/options.h"
#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// Relative width to which the first change of a verdict is found.
inline constexpr double kOnsetPrecision = 0.01;

/// Observes a case over an axis: coarse samples over the range, then bisection between the neighbours where the verdict
/// is first degraded, and first broken, to kOnsetPrecision of the value (whole numbers: to 1). Verdicts that get better
/// again later are noted. Returns the case's record without its limits; not available where the first observation
/// throws Error.
records::StressCase find_onsets(const Case& item, const Axis& axis);

/// Compares a case's onsets with its theories: agreement within the tolerance of the theory's kind, or an explanation.
/// A theory beyond the range agrees where nothing was met in it, one before the range where the range begins with what
/// it predicts, and one that says that there is none where there is none.
std::vector<records::StressLimit> compare(const Case& item, const records::StressCase& record, const Axis& axis);

/// The options of `shadowbench stress`.
struct StressOptions {
  options::Resources resources;
  std::vector<filters::FilterRequest> filters;
  std::string axes;                 ///< comma-separated ids; empty: all
  std::vector<std::string> ranges;  ///< AXIS=LO,HI
  gl::Backend backend = gl::Backend::kAuto;
  std::uint32_t seed = 1;
  std::filesystem::path out;
  bool force = false;                ///< as in options::RunOptions
  std::vector<std::string> command;  ///< the command line, for the record
};

/// The outcome of all axes.
struct StressOutcome {
  std::string text;       ///< the table of limits, for a terminal
  int disagreements = 0;  ///< limits that are not what theory says, with no explanation
};

/// Drives the chosen filters along the chosen axes and writes stress.html, .md, .json and .csv.
/// Bad axes and ranges are found before anything is made. Cost: about a second per axis and filter in software.
/// Throws Error(kUsage) as choose_axes and apply_range, Error(kContext), Error(kOutput).
StressOutcome run_stress(const StressOptions& options, options::Progress& progress);

/// Lists the axes with range, bound and filters that name them, for people.
std::string describe_axes(const std::vector<filters::FilterRequest>& filters);

}  // namespace shadowbench::stress
