#pragma once

#include <string>

#include "harness/run/run_plan.h"

namespace shadowbench::run {

/// Compiles every user's filter that has a cell to be measured, once, each in a process of its own.
/// Throws FilterErrors with the mistakes of all of them, and Error for what else a process refuses.
void check_user_filters(const RunPlan& plan, const std::string& backend);

}  // namespace shadowbench::run
