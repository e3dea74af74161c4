#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "report/analysis/cells.h"
#include "report/images/sheet.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// Names the sheets of a grid of so many filters, the first by its path: "cubes.grid.png", "cubes.grid.2.png".
std::vector<std::string> list_sheets(const std::string& grid, std::size_t filters);

/// What grids say of cells beside their errors.
struct GridWords {
  struct OfCell {
    std::string cost;  ///< the mean over the scenes and views of its configuration
    std::string role;  ///< "fast", "fast and best"; empty where it is no pick
  };
  std::map<std::string, OfCell> of_cells;  ///< by key
  std::string cost_note;                   ///< what costs are
};

/// Finds them for all cells of a run.
GridWords list_grid_words(const std::vector<records::CellRecord>& cells, const records::GlRecord& gl);

/// Makes the sheets of one grid from the images of the report folder: truth first, then filters by their error. A cell
/// whose images cannot be read says so. Empty where none can be read, or no cell names a grid. Cost: reads one float
/// image and one picture for each cell.
std::vector<images::Sheet> make_sheets(const std::filesystem::path& dir, const analysis::CellGroup& group,
                                       const GridWords& words);

/// Draws the grids that cells name. Throws Error(kOutput). Cost: as make_sheets(), several at once.
void write_grids(const std::filesystem::path& dir, const std::vector<records::CellRecord>& cells,
                 const records::GlRecord& gl, images::SheetWidth width = {});

}  // namespace shadowbench::pages
