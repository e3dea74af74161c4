#pragma once

#include <string>
#include <vector>

namespace shadowbench::analysis {

/// How fronts are read: what dominated and tied mean, what the intervals are, how scenes are combined.
std::vector<std::string> explain_fronts();

}  // namespace shadowbench::analysis
