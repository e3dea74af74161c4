#pragma once

#include <filesystem>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::run {

/// Joins the report folders of an experiment's shards into one, which equals that of the whole experiment in everything
/// but times, load and work done, and in what the OpenGL of a shard draws differently.
///
/// Throws Error(kInput) for a folder without readable results, with links, or of another experiment or program;
/// Error(kUsage) where shards overlap or one is missing, and where `out` has cells of another experiment or is one of
/// the folders; Error(kOutput). Nothing is written before all folders are read. Cost: a copy of every file that a cell
/// names. `force` as in options::RunOptions.
void merge_runs(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& out,
                bool force = false);

/// Joins what is common to the cells of several runs: works are added up, scenes and warnings are named once; all else
/// is of the first. Requires one run at least.
records::RunRecord join_runs(const std::vector<records::RunRecord>& runs);

/// Writes the pages and tables of a finished report again, with what lies in its folder by now. Throws Error(kInput)
/// where there is no report, Error(kOutput) where another process has the folder.
void rewrite_report(const std::filesystem::path& report);

}  // namespace shadowbench::run
