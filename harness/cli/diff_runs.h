#pragma once

#include <filesystem>

namespace shadowbench::cli {

/// Does an argument of `diff` name a run: a folder, or a .json file?
bool is_run(const std::filesystem::path& argument);

/// Prints how many ratios to `none` of the cells that two runs have in common repeat, and the ones that do so least.
/// Throws Error(kLimit) where some do not, Error(kInput) where there is nothing to compare or a file cannot be read.
int diff_runs(const std::filesystem::path& a, const std::filesystem::path& b, bool json);

}  // namespace shadowbench::cli
