#pragma once

#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// Relative width to which the first change of a verdict is found.
inline constexpr double kOnsetPrecision = 0.01;

/// Observes a case over an axis: coarse samples over the range, then bisection between the neighbours where the verdict
/// is first degraded, and first broken, to kOnsetPrecision of the value (whole numbers: to 1). Verdicts that get better
/// again later are noted. Returns the case's record without its limits; not available where the first observation
/// throws Error.
records::StressCase find_onsets(const Case& item, const Axis& axis);

/// Compares a case's onsets with its theories: agreement within the tolerance of the theory's kind, or an explanation.
/// A theory beyond the range agrees where nothing was met in it, one before the range where the range begins with what
/// it predicts, and one that says that there is none where there is none.
std::vector<records::StressLimit> compare(const Case& item, const records::StressCase& record, const Axis& axis);

}  // namespace shadowbench::stress
