#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "report/analysis/advice.h"

namespace shadowbench::analysis {

/// Writes a cost for people, with its unit: "4.39 ms (CPU)", "4194304 bytes", "4 fetches".
std::string format_cost(double value, const CostKind& cost, const records::GlRecord& gl);

/// Writes a number near to a value and between two ends, with as many digits, three or more, as that takes.
std::string format_within(double value, double low, double high);

/// Writes a limit that lets a value pass.
inline std::string format_limit(double value) {
  return format_within(value, value, std::numeric_limits<double>::infinity());
}

/// Writes a value so that it shows that it keeps a limit.
inline std::string format_kept(double value, double most) { return format_within(value, 0.0, most); }

/// Says behind a cost what it is paid for: " a frame, moving light"; empty where that is not time.
std::string describe_frame(const AdviceRequest& request);

/// Says what its cost is: of a frame, of which one, and what is left out.
std::string describe_cost(const Advice& advice);

/// Which demands a candidate that fails breaks, and by what: "--max-rmse 0.03 with 0.04 and --max-ms 5 with 10".
std::string describe_broken(const Advice& advice, const Candidate& candidate);

/// Of how many lights of a run is known which filter is better.
struct JudgedLights {
  std::size_t judged = 0;
  std::size_t of = 0;
};

/// Counts them: all that were tested in a view, also where the choice does not matter.
JudgedLights count_judged_lights(const Advice& advice);

/// Says it on one line, with the lights that were not tested and why; empty where all were.
std::string describe_judged_lights(const Advice& advice);

/// Says on one line what is nearest to the demands. Requires that nothing keeps them all.
std::string describe_failure(const Advice& advice);

/// Says in one sentence each what weakens the advice.
std::vector<std::string> list_advice_notes(const Advice& advice, const records::GlRecord& gl);

/// Counts the configurations that could not be judged, by reason: "3 not measured on stack".
std::vector<std::string> count_unjudged(const Advice& advice);

}  // namespace shadowbench::analysis
