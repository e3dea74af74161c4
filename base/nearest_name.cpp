#include "base/nearest_name.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace shadowbench {
namespace {

std::string to_lower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known,
                                        std::size_t part) {
  constexpr std::size_t kLongestName = 256;
  if (name.size() > kLongestName) return std::nullopt;
  const std::string wanted = to_lower(name);
  std::optional<std::string> nearest;
  std::size_t nearest_distance = kLongestName;
  for (const std::string& candidate : known) {
    if (candidate.size() > kLongestName) continue;
    const std::size_t distance = edit_distance(wanted, to_lower(candidate));
    const std::size_t limit = std::max<std::size_t>(1, std::max(wanted.size(), candidate.size()) / part);
    if (distance > limit || distance >= nearest_distance) continue;
    nearest = candidate;
    nearest_distance = distance;
  }
  return nearest;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known, std::size_t part) {
  const std::optional<std::string> near = nearest_name(name, known, part);
  return near ? fmt::format("; did you mean '{}'?", *near) : "";
}

std::string did_you_mean_or_known(std::string_view name, const std::vector<std::string>& known) {
  const std::string hint = did_you_mean(name, known);
  return hint.empty() && !known.empty() ? fmt::format("; known: {}", fmt::join(known, ", ")) : hint;
}

}  // namespace shadowbench
