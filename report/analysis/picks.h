#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "report/analysis/advice.h"

namespace shadowbench::analysis {

/// A seam from here on is seen: a step of brightness of 2 %, about Weber's fraction of the eye.
inline constexpr double kVisibleSeam = 0.02;

/// An RMSE that is tied with the least is no best one where it is larger than this many times that: too few phases
/// tell.
inline constexpr double kMostOfTie = 1.1;

/// What an answer may be called, the cheapest first.
inline constexpr const char *kFast = "fast", *kBalanced = "balanced", *kBest = "best";

/// One of the answers that a reader chooses from.
struct Pick {
  std::vector<std::string> names;  ///< of those above: one, or fast and best
  std::size_t index = 0;           ///< into Advice::keeping
  std::string why;
};

/// Lists them, the cheapest first; none is beaten by a candidate that keeps the demands. *Fast* is the first that is
/// advised. *Best* is the cheapest whose RMSE over the places is not clearly above the least; there is none where no
/// RMSE is known, or that RMSE is more than a tenth above the least all the same, as too few phases tell. *Balanced*
/// is, of those between the two, the one furthest below the straight line from fast to best in the plane of cost and
/// RMSE (the knee; Satopaa et al. 2011, Finding a "Kneedle" in a Haystack); its RMSE is clearly less than that of the
/// fast one, and its cost clearly less than that of the best. Costs that cannot be compared leave it out. Where the
/// cost and RMSE of another cannot be told from a pick's, that with the smaller seam between cascades is picked; a seam
/// that is seen is said. Requires one that keeps the demands.
std::vector<Pick> list_picks(const Advice& advice);

/// The sentences of an answer, by name, with names and numbers in braces; a page's script fills the same.
const std::map<std::string, std::string>& answer_words();

/// Says in a sentence which filter to use, and which where shadows must look right. Requires one that keeps the
/// demands.
std::string describe_choice(const Advice& advice);

/// Says which filters on smaller maps a candidate beats: "its larger map beats pcss, map 1024"; empty where it is none.
std::string describe_larger_map(const Candidate& candidate, const std::vector<Candidate>& others);

}  // namespace shadowbench::analysis
