#pragma once

#include <string>

#include "harness/measure/scene_assets.h"
#include "report/records/records.h"

namespace shadowbench::run {

/// The commit that the program was built from, "+" appended where the tree had changes; "unknown" without git.
std::string build_commit();

/// Describes processor, cores, load, compiler and operating system.
records::MachineRecord describe_machine();

/// The GL and the clock that times come from.
records::GlRecord describe_gl(const measure::Renderer& renderer);

}  // namespace shadowbench::run
