#pragma once

#include <filesystem>

#include "report/records/flicker_record.h"

namespace shadowbench::pages {

/// Writes flicker.json, .csv, .md, .html, and the plots with their script, flicker.gp, into a folder; the pictures by
/// pixel are there already. Sets `record.no_plots` where gnuplot did not draw, which stops nothing. Throws
/// Error(kOutput).
void write_flicker_files(const std::filesystem::path& dir, records::FlickerRecord& record);

}  // namespace shadowbench::pages
