#include "harness/stress/explain.h"

#include <fmt/format.h>

#include <algorithm>

namespace shadowbench::stress {

std::string explain_broken_throughout(const Disagreement& missed) {
  const bool throughout = std::ranges::all_of(
      missed.record.samples, [](const records::StressSample& sample) { return sample.verdict == Verdict::kBroken; });
  if (!throughout || !missed.record.broken) return {};
  return fmt::format("with the chosen parameters it is broken at every value ({}), which is not this axis' doing",
                     missed.record.broken->why);
}

}  // namespace shadowbench::stress
