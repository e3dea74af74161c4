#pragma once

#include <memory>

#include "harness/options/progress.h"

namespace shadowbench::cli {

/// Shows progress on standard error: one line that is redrawn on a terminal, plain lines elsewhere.
std::unique_ptr<options::Progress> make_progress();

}  // namespace shadowbench::cli
