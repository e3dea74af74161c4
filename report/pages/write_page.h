#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "report/document/blocks.h"
#include "report/images/figure.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// One of the program's pages, and where it lies in a report's folder.
struct PageFile {
  std::string_view command;       ///< the command that makes it
  std::string_view folder;        ///< within the report's folder; empty: that folder itself
  std::string_view html;          ///< file name
  std::string_view markdown;      ///< file name
  std::string_view title;         ///< for links to it
  std::string_view details = {};  ///< the whole page as Markdown, where `markdown` has a summary of it
};

/// Lists the program's pages.
const std::vector<PageFile>& list_pages();

/// Writes a command's page into a folder as HTML and as Markdown, linked with the program's other pages that are there
/// already, and these with it. Throws Error(kOutput).
void write_page(const std::filesystem::path& dir, std::string_view command, document::Page page);

/// Writes the HTML alone, of work that goes on, and removes the Markdown: where that is, the page is whole.
/// Throws Error(kOutput).
void write_early_page(const std::filesystem::path& dir, std::string_view command, const document::Page& page);

/// Whether a folder has a command's page, whole.
bool has_page(const std::filesystem::path& dir, std::string_view command);

/// Removes a command's page from a folder, where it is there.
void remove_page(const std::filesystem::path& dir, std::string_view command);

/// Links to data files that lie beside the page.
document::Links link_data(const std::vector<std::string>& files);

/// Writes what is made of finished cells into a report folder: results.json and its schema, timings.csv, accuracy.csv,
/// summary.md and index.html; the grids that cells name. `keys` names the cell files that belong to the run, in the
/// order they are to be listed. results.json comes last: where it is, the report is whole. Throws Error(kInput) for a
/// cell file, Error(kOutput) for the others. Cost: memory of all records, and of what write_grids() reads.
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
