#pragma once

#include <memory>

#include "harness/cli/interruption.h"
#include "harness/options/progress.h"

namespace shadowbench::cli {

/// Shows progress on standard error: one line that is redrawn on a terminal, plain lines elsewhere.
std::unique_ptr<options::Progress> make_progress();

/// Does work that writes to the folder `out`: shows its progress, and removes what is half-written where a signal ends
/// it. Returns what the work returns.
template <class Work>
auto work_with_progress(const std::filesystem::path& out, const Work& work,
                        const std::string& advice = kStoppedAdvice) {
  const Interruption interruption(out, advice);
  const std::unique_ptr<options::Progress> progress = make_progress();
  return work(*progress);
}

}  // namespace shadowbench::cli
