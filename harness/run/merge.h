#pragma once

#include <filesystem>
#include <vector>

namespace shadowbench::run {

/// Joins the report folders of an experiment's shards into one, which equals that of the whole experiment in everything
/// but times, load and work done.
///
/// Throws Error(kInput) for a folder without readable results, or of another experiment, program or OpenGL;
/// Error(kUsage) where shards overlap or one is missing, and where `out` has cells of another experiment or is one of
/// the folders; Error(kOutput). Nothing is written before all folders are read. Cost: a copy of every file that a cell
/// names.
void merge_runs(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out);

}  // namespace shadowbench::run
