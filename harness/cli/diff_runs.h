#pragma once

#include <filesystem>

namespace shadowbench::cli {

/// Whether an argument of `diff` names a run, which is a folder or a .json file.
bool is_run(const std::filesystem::path& argument);

/// Compares the ratios to `none` of the cells that two runs have in common; prints how many repeat, and the ones that
/// are farthest apart.
/// Throws Error(kLimit) where some do not, Error(kInput) where there is nothing to compare or a file cannot be read.
int diff_runs(const std::filesystem::path& a, const std::filesystem::path& b, bool json);

}  // namespace shadowbench::cli
