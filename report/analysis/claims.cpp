#include "report/analysis/claims.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/records/absence.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr const char* kGrowth = "penumbra.growth";
constexpr double kLeastGrowth = 0.5;  ///< nearer to the truth's 1 than to the 0 of one width for all

}  // namespace

std::string find_doubt(const std::vector<const records::CellRecord*>& cells, const std::string& claim) {
  const std::string doubt = fmt::format("'{}' is claimed, not shown: ", claim);
  if (claim != kContactHardening) return doubt + "nothing is measured of it";
  const records::CellRecord* least = nullptr;
  for (const records::CellRecord* cell : cells)
    if (cell->penumbra.growth && (!least || *cell->penumbra.growth < *least->penumbra.growth)) least = cell;
  if (!least) return doubt + records::explain_absence(*cells.front(), kGrowth);
  if (*least->penumbra.growth >= kLeastGrowth) return "";
  return fmt::format("{}on {} its penumbrae widen by {} where the truth's widen by 1, and {} is the least", doubt,
                     least->scene, records::format_number(least->penumbra.growth), kLeastGrowth);
}

bool shows_claim(const std::vector<const records::CellRecord*>& cells, const std::string& claim) {
  return std::ranges::count(cells.front()->claims, claim) > 0 && find_doubt(cells, claim).empty();
}

}  // namespace shadowbench::analysis
