#pragma once

#include <string>
#include <vector>

namespace shadowbench::analysis {

/// A share of something, as it is read, and whose it is.
struct Rated {
  std::string name;
  double rate = 0.0;
  std::string text;  ///< "22 %"
};

/// Lists a few names: "a, b, c and 5 more".
std::string list_some(const std::vector<std::string>& names);

/// Says who has the least and who the most: "from 1 % under slope to 50 % under plane, constant, which tie". What reads
/// the same is a tie; where all read the same, that is said once. `link` stands before the names, and `kind` says what
/// they are. Requires one at least.
std::string describe_extremes(const std::vector<Rated>& all, const char* link, const char* kind);

}  // namespace shadowbench::analysis
