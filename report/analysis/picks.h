#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/advice.h"

namespace shadowbench::analysis {

/// The answers that a reader chooses from, each an index into Advice::keeping.
struct Picks {
  std::size_t fast = 0;                 ///< the first: the cheapest
  std::optional<std::size_t> balanced;  ///< the knee between the two; nothing where the two have none between them
  std::optional<std::size_t> best;  ///< the least RMSE; nothing where a candidate's is unknown, or the fast one has it
};

/// Finds them. *Best* is the cheapest whose RMSE over the places is not clearly above the least. *Balanced* is, of
/// those between the other two, the one furthest below the straight line from fast to best in the plane of cost and
/// RMSE (the knee; Satopaa et al. 2011, Finding a "Kneedle" in a Haystack); its RMSE is clearly less than that of the
/// fast one, and its cost clearly less than that of the best. Costs that cannot be compared leave it out. Requires one
/// that keeps the demands.
Picks find_picks(const Advice& advice);

/// One of them for people: what it is called, its index, and why it is there.
struct NamedPick {
  std::string name;  ///< "fast", "balanced", "best", or "fast and best"
  std::size_t index = 0;
  std::string why;
};

/// Lists the picks, the cheapest first.
std::vector<NamedPick> name_picks(const Advice& advice);

}  // namespace shadowbench::analysis
