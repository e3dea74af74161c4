#pragma once

#include <optional>
#include <string>

#include "report/records/stress_record.h"

namespace shadowbench::stress {

using Verdict = records::StressVerdict;

/// What a case saw at one value of its axis.
struct Observation {
  Verdict verdict = Verdict::kOk;
  std::optional<double> measured;  ///< what the axis says it measures; empty where it is not finite
  std::string why;                 ///< what decided the verdict, in words with the number; empty for kOk
};

}  // namespace shadowbench::stress
