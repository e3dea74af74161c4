#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/analysis/advice.h"

namespace shadowbench::analysis {

/// What an answer may be called, the cheapest first.
inline constexpr const char *kFast = "fast", *kBalanced = "balanced", *kBest = "best";

/// One of the answers that a reader chooses from.
struct Pick {
  std::vector<std::string> names;  ///< of those above: one, or fast and best
  std::size_t index = 0;           ///< into Advice::keeping
  std::string why;
};

/// Lists them, the cheapest first. *Fast* is the first that keeps the demands. *Best* is the cheapest whose RMSE over
/// the places is not clearly above the least; there is none where an RMSE is unknown. *Balanced* is, of those between
/// the two, the one furthest below the straight line from fast to best in the plane of cost and RMSE (the knee; Satopaa
/// et al. 2011, Finding a "Kneedle" in a Haystack); its RMSE is clearly less than that of the fast one, and its cost
/// clearly less than that of the best. Costs that cannot be compared leave it out. Requires one that keeps the demands.
std::vector<Pick> list_picks(const Advice& advice);

}  // namespace shadowbench::analysis
