#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/context/context.h"
#include "harness/options/options.h"
#include "harness/options/progress.h"

namespace shadowbench::stress {

/// The options of `shadowbench stress`.
struct StressOptions {
  options::Resources resources;
  std::vector<filters::FilterRequest> filters;
  std::string axes;                 ///< comma-separated ids; empty: all
  std::vector<std::string> ranges;  ///< AXIS=LO,HI
  gl::Backend backend = gl::Backend::kAuto;
  std::uint32_t seed = 1;
  std::filesystem::path cache;  ///< keeps traced truth; empty: nothing is kept
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
