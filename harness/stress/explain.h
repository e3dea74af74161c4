#pragma once

#include <string>

#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// Explains a theory that is not met because the case is broken over the whole range, whatever the axis' value: a map
/// that overflows with the chosen parameters, for instance. Empty where it is not.
std::string explain_broken_throughout(const Disagreement& missed);

}  // namespace shadowbench::stress
