#pragma once

#include <filesystem>
#include <vector>

#include "filters/filter_spec.h"

namespace shadowbench::records {

/// Leaves in a run's folder, as filter_mistakes.json, why the run measured nothing; none: takes that away again.
/// Throws Error(kOutput).
void write_filter_mistakes(const std::filesystem::path& folder, const std::vector<filters::FilterMistake>& mistakes);

/// Reads what was left there; none where nothing was. Throws Error(kInput) for a file that is none of ours.
std::vector<filters::FilterMistake> read_filter_mistakes(const std::filesystem::path& folder);

}  // namespace shadowbench::records
