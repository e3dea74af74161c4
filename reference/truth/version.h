#pragma once

#include <string>

namespace shadowbench::truth {

/// Names the code that traces: it changes with the sources of this folder and of the kernels, and with Embree's
/// version.
std::string truth_version();

}  // namespace shadowbench::truth
