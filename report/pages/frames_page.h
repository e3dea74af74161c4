#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysis/cells.h"
#include "report/document/blocks.h"

namespace shadowbench::pages {

/// How many frames of a filter equal one frame of the same filter with 16 taps.
struct TapEquivalence {
  std::string filter;  ///< as the group names its cells
  int taps = 0;
  const records::ResolveRecord* mean = nullptr;  ///< the plain mean of the view without jitter
  std::optional<int> by_noise;                   ///< frames whose noise is no larger; nothing: the run has too few
  std::optional<int> by_error;                   ///< the same of the error
};

/// Lists the cells of a group that have taps, where one has 16, and noise, and is else alike. Points into the group.
std::vector<TapEquivalence> list_equivalences(const analysis::CellGroup& group);

/// Makes the page of `run --frames`. Requires a cell that was accumulated.
document::Page make_frames_page(const std::vector<records::CellRecord>& cells, const records::RunRecord& run);

}  // namespace shadowbench::pages
