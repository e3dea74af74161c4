#include "report/pages/write_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <fstream>
#include <iterator>
#include <optional>

#include "base/files.h"
#include "report/analysis/cells.h"
#include "report/analysis/findings.h"
#include "report/pages/frames_page.h"
#include "report/pages/grid_sheets.h"
#include "report/pages/run_page.h"
#include "report/records/bias_record.h"
#include "report/records/csv_tables.h"
#include "report/records/json_io.h"

namespace shadowbench::pages {
namespace {

const PageFile& find_page(std::string_view command) {
  const auto own = std::ranges::find(list_pages(), command, &PageFile::command);
  assert(own != list_pages().end());
  return *own;
}

/// Finds another page as seen from one in `dir`: in the same folder, or at its place in the same report.
std::optional<std::filesystem::path> find_sibling(const std::filesystem::path& dir, const PageFile& own,
                                                  const PageFile& other) {
  std::vector<std::filesystem::path> places = {other.html};
  const std::filesystem::path in_report = std::filesystem::path(other.folder) / other.html;
  if (own.folder.empty())
    places.push_back(in_report);
  else if (std::filesystem::absolute(dir / own.html).lexically_normal().parent_path().filename() == own.folder)
    places.push_back(".." / in_report);
  const auto exists = [&](const std::filesystem::path& place) {
    std::error_code ignored;
    return std::filesystem::is_regular_file((dir / place).lexically_normal(), ignored);
  };
  const auto found = std::ranges::find_if(places, exists);
  return found == places.end() ? std::nullopt : std::optional(*found);
}

std::vector<document::Link> list_siblings(const std::filesystem::path& dir, const PageFile& own) {
  std::vector<document::Link> siblings;
  for (const PageFile& other : list_pages()) {
    if (other.command == own.command) continue;
    if (const auto path = find_sibling(dir, own, other))
      siblings.push_back({path->generic_string(), std::string(other.title)});
  }
  return siblings;
}

/// What of a page is brief, without what is folded away, and where the rest is.
document::Page summarise(document::Page page, const PageFile& own) {
  std::erase_if(page.sections, [](const document::Section& section) { return !section.brief; });
  for (document::Section& section : page.sections)
    std::erase_if(
        section.blocks, [](const auto& block) { return std::holds_alternative<document::Details>(block); });
  const auto link = [](std::string_view file) { return document::Link{std::string(file), std::string(file)}; };
  page.sections.push_back({"more", "", {document::Links{"More:", {link(own.html), link(own.details)}}}});
  return page;
}

/// A page that was written earlier does not know yet what lies beside it now.
void link_back(const std::filesystem::path& path) {
  const auto own = std::ranges::find(list_pages(), path.filename().string(), &PageFile::html);
  std::ifstream stream(path, std::ios::binary);
  const std::string html{std::istreambuf_iterator<char>(stream), {}};
  const std::string linked = document::replace_siblings(html, list_siblings(path.parent_path(), *own));
  if (stream && linked != html) write_text_file(path, linked);
}

}  // namespace

const std::vector<PageFile>& list_pages() {
  static const std::vector<PageFile> pages = {
      {"run", "", "index.html", "summary.md", "the run: cost, error and trade", "details.md"},
      {"frames", "", "frames.html", "frames.md", "accumulation over frames"},
      {"stress", "stress", "stress.html", "stress.md", "stress: where filters break"},
      {"bias", "bias", "bias.html", "bias.md", "depth bias"},
      {"tune", "tune", "tune.html", "tune.md", "tuned parameters"},
      {"regress", "regress", "regress.html", "regress.md", "comparison with the baseline"}};
  return pages;
}

void write_page(const std::filesystem::path& dir, std::string_view command, document::Page page) {
  const PageFile& own = find_page(command);
  page.siblings = list_siblings(dir, own);
  write_text_file(dir / own.html, document::write_html(page, dir));
  if (!own.details.empty()) {
    write_text_file(dir / own.details, document::write_markdown(page));
    page = summarise(std::move(page), own);
  }
  write_text_file(dir / own.markdown, document::write_markdown(page));
  for (const document::Link& sibling : page.siblings) link_back((dir / sibling.path).lexically_normal());
}

void write_early_page(const std::filesystem::path& dir, std::string_view command, const document::Page& page) {
  const PageFile& own = find_page(command);
  std::error_code ignored;
  for (const std::string_view name : {own.markdown, own.details})
    if (!name.empty()) std::filesystem::remove(dir / name, ignored);
  write_text_file(dir / own.html, document::write_html(page, dir));
}

bool has_page(const std::filesystem::path& dir, std::string_view command) {
  const PageFile& own = find_page(command);
  return std::filesystem::exists(dir / own.html) && std::filesystem::exists(dir / own.markdown);
}

void remove_page(const std::filesystem::path& dir, std::string_view command) {
  const PageFile& own = find_page(command);
  std::error_code ignored;
  for (const std::string_view name : {own.html, own.markdown, own.details})
    if (!name.empty()) std::filesystem::remove(dir / name, ignored);
}

document::Links link_data(const std::vector<std::string>& files) {
  document::Links links{"Data:", {}};
  for (const std::string& file : files) links.items.push_back({file, file});
  return links;
}

namespace {

/// Puts the warnings of the machines and of the cells, which change numbers, before those of the scenes, each once.
void add_warnings(records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> warnings;
  const auto add = [&](const std::string& warning) {
    if (std::ranges::count(warnings, warning) == 0) warnings.push_back(warning);
  };
  if (analysis::mixes_machines(cells)) add(analysis::warn_of_mixed_machines(cells));
  for (const records::CellRecord& cell : cells) std::ranges::for_each(cell.warnings, add);
  std::ranges::for_each(run.warnings, add);
  run.warnings = std::move(warnings);
}

}  // namespace

void write_report(const std::filesystem::path& dir, records::RunRecord run, const std::vector<std::string>& keys) {
  write_report(dir, std::move(run), records::read_cells(dir, keys));
}

void write_report(const std::filesystem::path& dir, records::RunRecord run,
                  const std::vector<records::CellRecord>& cells, images::SheetWidth width) {
  const std::vector<records::BiasCell> biases = records::read_recommended_biases(dir, run.warnings);
  add_warnings(run, cells);
  write_text_file(dir / "timings.csv", records::make_csv(records::CsvTable::kTimings, run, cells));
  write_text_file(dir / "accuracy.csv", records::make_csv(records::CsvTable::kAccuracy, run, cells));
  const auto withheld = analysis::withhold_mixed_times(cells);
  const std::vector<records::CellRecord>& shown = withheld ? *withheld : cells;
  if (std::ranges::any_of(cells, [](const records::CellRecord& cell) { return cell.accumulation.has_value(); }))
    write_page(dir, "frames", make_frames_page(cells, run));
  else
    remove_page(dir, "frames");  // of another run into this folder
  write_grids(dir, shown, run.gl, width);
  write_page(dir, "run", make_run_page(run, shown, biases));
  records::write_results(dir, run, cells);
}

void write_early_report(const std::filesystem::path& dir, records::RunRecord run,
                        const std::vector<records::CellRecord>& cells, const std::string& so_far,
                        images::SheetWidth width) {
  add_warnings(run, cells);
  const auto withheld = analysis::withhold_mixed_times(cells);
  const std::vector<records::CellRecord>& shown = withheld ? *withheld : cells;
  write_grids(dir, shown, run.gl, width);
  write_early_page(dir, "run", make_run_page(run, shown, {}, so_far));
}

}  // namespace shadowbench::pages
