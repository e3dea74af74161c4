#include "report/regress/accept.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"

namespace shadowbench::regress {
/// Ratios that no run is compared with are not kept: they would only make the files differ.
BaselineCell Accepter::make_cell(const ActualCell& cell) const {
  const records::CellRecord& record = cell.record;
  ComparedValues values = read_values(record);
  const auto is_ignored = [&](const auto& value) {
    return std::isinf(tolerances_.find(record.filter, value.first).limit);
  };
  std::erase_if(values.ratios, is_ignored);
  return {name_cell(record), record.map_size, record.width, record.height, cell.origin, std::move(values)};
}

/// A file that cannot be read keeps only its numbers, if those can be read, and the cells that are taken over now.
CellFile& Accepter::file(const std::string& scene, const std::string& filter) {
  const auto [place, is_new] = files_.try_emplace({scene, filter});
  if (!is_new) return place->second;
  try {
    place->second = baseline_.read_cells(scene, filter);
    return place->second;
  } catch (const Error&) {
    place->second = {};
  }
  try {
    place->second.cells = baseline_.read_numbers(scene, filter);
  } catch (const Error& error) {
    lines_.push_back(fmt::format("lost: every other cell of {} {}: {}", scene, filter, error.what()));
  }
  return place->second;
}

std::map<std::string, TruthImages>& Accepter::truths(const std::string& scene) {
  const auto [place, is_new] = truths_.try_emplace(scene);
  if (!is_new) return place->second;
  try {
    place->second = baseline_.read_truths(scene);
  } catch (const Error& error) {
    lines_.push_back(fmt::format("lost: the truth of every other view of {}: {}", scene, error.what()));
  }
  return place->second;
}

void Accepter::take(Comparison& comparison, const ActualCell& cell) {
  if (!comparison.differs() || cell.images.visibility.empty()) return;
  CellFile& own = file(cell.record.scene, cell.record.filter);
  BaselineCell taken = make_cell(cell);
  const auto same = std::ranges::find(own.cells, taken.key, &BaselineCell::key);
  if (same == own.cells.end())
    own.cells.push_back(std::move(taken));
  else
    *same = std::move(taken);
  CellImages& kept = own.images[cell.record.key] = cell.images;
  kept.uncertainty.rounding = coarsen_rounding(cell.images.uncertainty.rounding);
  note(comparison, comparison.outcome == Outcome::kExtra ? "added" : "replaced");
}

void Accepter::take(Comparison& comparison, const ActualTruth& truth) {
  if (!comparison.differs()) return;
  truths(truth.record.scene)[comparison.key] = truth.images;
  note(comparison, comparison.outcome == Outcome::kExtra ? "added" : "replaced");
}

void Accepter::drop(Comparison& comparison) {
  if (comparison.filter == kTruthName) {
    truths(comparison.scene).erase(comparison.key);
  } else {
    CellFile& own = file(comparison.scene, comparison.filter);
    std::erase_if(own.cells, [&](const BaselineCell& each) { return each.key == comparison.key; });
  }
  note(comparison, "removed");
}

void Accepter::note(Comparison& comparison, const std::string& what) {
  comparison.accepted = true;
  std::string line = fmt::format("{}: {} {} ({})", what, comparison.scene, comparison.label, comparison.settings);
  if (comparison.outcome != Outcome::kExtra)
    for (const Finding& finding : comparison.findings) line += "\n  - " + finding.text;
  lines_.push_back(std::move(line));
}

std::vector<std::string> Accepter::write() {
  // Tolerances come first: a folder that is written only in part is then known to be a baseline.
  if (!baseline_.exists()) write_text_file(baseline_.tolerance_file(), write_tolerances(tolerances_));
  for (const auto& [name, own] : files_) baseline_.write_cells(name.first, name.second, own);
  for (const auto& [scene, truths] : truths_) baseline_.write_truths(scene, truths);
  return lines_;
}

}  // namespace shadowbench::regress
