#pragma once

#include <filesystem>

#include "report/records/stress_record.h"

namespace shadowbench::pages {

/// Writes stress.json, .csv, .md, .html, and the plots with their script, stress.gp, into a folder. Sets
/// `record.no_plots` where gnuplot did not draw them, which stops nothing. Throws Error(kOutput).
void write_stress_files(const std::filesystem::path& dir, records::StressRecord& record);

}  // namespace shadowbench::pages
