#pragma once

#include "harness/view/time_meter.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

/// Lays out the times of both sides, with their history, in the current ImGui window.
void show_times(const Workbench& bench, const TimeMeter& meter);

}  // namespace shadowbench::view
