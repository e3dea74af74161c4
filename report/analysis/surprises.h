#pragma once

#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// At most so many sentences are said of a run.
inline constexpr std::size_t kMostSurprises = 5;

/// Says what a reader of the numbers would not expect, in at most kMostSurprises sentences: filters that are suspect or
/// did not finish; of equally wide kernels, those whose order turns over between scenes, and those that cost more for
/// no smaller error; an error that comes from another part than most; a fault that only one filter is free of.
std::vector<std::string> list_surprises(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
