#pragma once

#include <memory>

#include "harness/cli/interruption.h"
#include "harness/options/progress.h"

namespace shadowbench::cli {

/// Shows progress on standard error: one line that is redrawn on a terminal; elsewhere a line for each fifth of the
/// work, or for every step.
std::unique_ptr<options::Progress> make_progress(bool every_step = false);

/// Does work that writes to the folder `out`: shows its progress, and removes what is half-written where a signal ends
/// it. Returns what the work returns.
template <class Work>
auto work_with_progress(const std::filesystem::path& out, const Work& work, const std::string& advice = kStoppedAdvice,
                        bool every_step = false) {
  const Interruption interruption(out, advice);
  const std::unique_ptr<options::Progress> progress = make_progress(every_step);
  return work(*progress);
}

}  // namespace shadowbench::cli
