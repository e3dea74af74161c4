#include "report/regress/run_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::regress {
namespace {

bool chosen(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::ranges::find(names, name) != names.end();
}

using Parts = std::map<std::string, images::Image>;

/// The parts of an image file, by name; the reason where it cannot be read.
struct ImageFile {
  Parts parts;
  std::string unreadable;
};

ImageFile read_image_file(const std::filesystem::path& path) {
  ImageFile file;
  try {
    for (images::Part& part : images::read_exr(path).parts) file.parts[part.name] = std::move(part.image);
  } catch (const Error& error) {
    file.unreadable = error.what();
  }
  return file;
}

images::Image find_part(const Parts& parts, const std::string& name) {
  const auto found = parts.find(name);
  return found == parts.end() ? images::Image() : found->second;
}

void read_images(ActualCell& cell, const ImageFile& file) {
  if (!file.unreadable.empty()) {
    cell.unreadable = file.unreadable;
    return;
  }
  const std::string prefix = *cell.record.images.parts + ".";
  cell.images.visibility = find_part(file.parts, prefix + "visibility");
  for (const images::UncertaintyImage& each : images::list_uncertainty_images())
    cell.images.uncertainty.*each.image = find_part(file.parts, prefix + each.id);
}

/// Why a cell has no image; empty where it has one.
std::string explain_no_image(const records::CellRecord& cell) {
  if (!records::is_drawn(cell)) return "the run could not measure it: " + records::describe_status(cell);
  if (!cell.images.exr || !cell.images.parts) return "the run kept no float images: run it with --grids";
  return "";
}

std::map<std::string, std::vector<const records::CellRecord*>> group_by_file(
    const std::vector<records::CellRecord>& cells) {
  std::map<std::string, std::vector<const records::CellRecord*>> groups;
  for (const records::CellRecord& cell : cells)
    groups[explain_no_image(cell).empty() ? *cell.images.exr : std::string()].push_back(&cell);
  return groups;
}

}  // namespace

bool Selection::holds(const std::string& scene, const std::string& filter) const {
  return chosen(scenes, scene) && chosen(filters, filter);
}

RunCells::RunCells(const std::filesystem::path& folder, const Selection& selection)
    : folder_(folder), results_(records::read_results(folder / "results.json")), all_(results_.cells) {
  std::erase_if(
      results_.cells, [&](const auto& cell) { return !selection.holds(cell.scene, cell.filter); });
}

Origin RunCells::origin() const {
  const records::RunRecord& run = results_.run;
  return {.seed = run.seed,
          .renderer = run.gl.renderer,
          .machine = fmt::format("{}, {} cores", run.machine.cpu, run.machine.cores),
          .commit = run.commit};
}

void RunCells::visit(const std::function<void(const ActualCell&)>& on_cell,
                     const std::function<void(const ActualTruth&)>& on_truth) const {
  std::set<std::string> seen;
  for (const auto& [name, cells] : group_by_file(results_.cells)) {
    const ImageFile file = name.empty() ? ImageFile() : read_image_file(folder_ / name);
    for (const records::CellRecord* record : cells) {
      ActualCell cell{*record, origin(), {}, explain_no_image(*record)};
      if (cell.unreadable.empty()) read_images(cell, file);
      on_cell(cell);
    }
    const ActualTruth truth{*cells.front(),
                            {find_part(file.parts, "truth.area"), find_part(file.parts, "truth.standard_error")}};
    if (!truth.images.area.empty() && seen.insert(cells.front()->scene + " " + truth_key(*cells.front())).second)
      on_truth(truth);
  }
}

}  // namespace shadowbench::regress
