#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/page/gnuplot.h"

namespace shadowbench::page {

/// Writes a gnuplot script into a report folder, at `script` in it, and has gnuplot draw its plots; each appears whole
/// or not at all. Returns why gnuplot drew none; nothing where it did: plots are a help for documents, and a report
/// does without. Throws Error(kOutput) where the disk is full.
std::optional<std::string> write_plot_files(const std::filesystem::path& dir, const std::filesystem::path& script,
                                            const std::vector<Plot>& plots);

}  // namespace shadowbench::page
