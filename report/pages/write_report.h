#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/images/figure.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Writes what is made of finished cells into a report folder: results.json and its schema, timings.csv, accuracy.csv,
/// summary.md and index.html; the grids that cells name; where there are cells to compare, fronts.csv. Times of other
/// machines, which lie in the folder, are costs in the latter two. `keys` names the cell files that belong to the run,
/// in the order they are to be listed. results.json comes last: where it is, the report is whole. Throws Error(kInput)
/// for a cell file, Error(kOutput) for the others. Cost: memory of all records, and of what write_grids() reads.
void write_report(const std::filesystem::path& dir, records::RunRecord run, const std::vector<std::string>& keys);

/// The same of cells that were read.
void write_report(const std::filesystem::path& dir, records::RunRecord run,
                  const std::vector<records::CellRecord>& cells, images::SheetWidth width = {});

/// Writes the page with its grids, and nothing else, of a run that goes on and has these cells; `so_far` says how far
/// it is.
void write_early_report(const std::filesystem::path& dir, records::RunRecord run,
                        const std::vector<records::CellRecord>& cells, const std::string& so_far,
                        images::SheetWidth width = {});

}  // namespace shadowbench::pages
