#pragma once

#include <filesystem>

#include "report/flicker_record.h"

namespace shadowbench::report {

/// Writes flicker.json, .csv, .md, .html, and the plots with their script, flicker.gp, into a folder; the pictures by
/// pixel are there already. Sets `record.no_plots` where gnuplot did not draw, which stops nothing. Throws
/// Error(kOutput).
void write_flicker_files(const std::filesystem::path& dir, FlickerRecord& record);

}  // namespace shadowbench::report
