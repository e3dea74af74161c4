#include "harness/view/side_measurement.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "harness/run/float_images.h"
#include "harness/view/view_state.h"
#include "report/images/image_library.h"
#include "report/images/picture_io.h"
#include "report/records/json_io.h"

namespace shadowbench::view {
namespace {

namespace fs = std::filesystem;

constexpr int kLowestPriority = 19;
constexpr const char *kExperimentName = "measured.toml", *kReportName = "report";

/// The folder for the files of all windows of this user.
fs::path find_place() { return fs::temp_directory_path() / fmt::format("shadowbench-view-{}", getuid()); }

/// The options of a run that takes no longer than it must: as few timed rounds as there may be, since times beside a
/// window say nothing. Its phases stay, because the first of them is what the window shows.
options::RunOptions make_quick(options::RunOptions options, Measurand measurand) {
  options.rounds = {.precision = 1.0, .budget_ms = 1.0};
  options.stability = measurand == Measurand::kEverything;
  options.gpus.clear();
  if (measurand == Measurand::kEverything) return options;
  options.filters.clear();
  options.attribution = false;
  options.phases = 1;
  return options;
}

/// No pictures are made but the float images.
std::vector<std::string> list_arguments(const options::RunOptions& options, const fs::path& folder,
                                        Measurand measurand) {
  std::vector<std::string> words = {"run",
                                    (folder / kExperimentName).string(),
                                    "--out",
                                    (folder / kReportName).string(),
                                    "--gl",
                                    name_of(options.backend),
                                    run::cache_word(options.cache),
                                    "--fresh",
                                    "--every-step",
                                    "--no-pictures"};
  if (measurand == Measurand::kEverything) words.emplace_back("--all-parts");
  return words;
}

/// What the process does: the end of its last line of progress, after the scene and the map. Empty: not known yet.
std::string find_step(const std::string& text) {
  constexpr std::string_view kBefore = " \u00b7 ";
  const std::size_t begin = text.rfind(kBefore);
  if (begin == std::string::npos) return {};
  const std::string step = text.substr(begin + kBefore.size());
  return step.substr(0, step.find('\n'));
}

/// The cells of a state's filters, in the order of its run, still without records.
MeasuredSides list_cells(const ViewState& state, Measurand measurand) {
  MeasuredSides sides;
  if (measurand == Measurand::kTruthAlone) return sides;
  const std::vector<filters::FilterRequest>& listed = state.options.filters;
  for (const filters::FilterRequest& request : listed) sides.cells.emplace_back().request = request;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (state.sides[side].truth) continue;
    const auto is_it = [&](const auto& each) { return filters::is_same(each, state.sides[side].filter); };
    sides.cell_of_side[side] = std::ranges::find_if(listed, is_it) - listed.begin();
  }
  return sides;
}

/// Opens what reads images, which takes longer than an image. Where it is not there, reading says so.
void open_for_reading() {
  try {
    images::open_image_library(ErrorKind::kInput);
  } catch (const Error&) {
  }
}

/// Reads what a finished run left. Once it is cancelled, what it gives is worth nothing.
MeasuredSides read_results(MeasuredSides sides, const fs::path& report, const std::atomic<bool>& is_cancelled) {
  records::Results results = records::read_results(report / "results.json");
  const fs::path images = report / results.cells.front().images.exr.value();
  const auto& absent = results.cells.front().absent;
  if (const auto reason = absent.find("error"); reason != absent.end()) sides.no_truth = reason->second;
  for (std::size_t i = 0; i < sides.cells.size(); ++i) {
    sides.cells[i].record = std::move(results.cells.at(i));
    sides.cells[i].label = sides.cells[i].record.images.parts.value();
  }
  images::ExrFile file = images::read_exr(images, [&](const std::string& part) {
    if (is_cancelled) return false;
    return part == run::kTruthPart || part == run::kTruthMaskPart ||
           std::ranges::any_of(sides.cells, [&](const auto& cell) {
             return part.starts_with(cell.label + ".") && part != run::picture_part(cell.label);
           });
  });
  for (measure::MeasuredCell& cell : sides.cells) run::take_float_images(cell, file.parts);
  for (images::Part& part : file.parts) {
    if (part.name == run::kTruthPart) sides.truth = std::move(part.image);
    if (part.name == run::kTruthMaskPart) sides.truth_mask = std::move(part.image);
  }
  return sides;
}

std::string explain(const run::WorkerOutcome& outcome) {
  if (outcome.signal != 0)
    return fmt::format("the run was killed by signal {} ({})", outcome.signal, strsignal(outcome.signal));
  return run::clean_message(outcome.error_text);
}

}  // namespace

const measure::MeasuredCell* MeasuredSides::find_side(std::size_t side) const {
  return cell_of_side[side] ? &cells[*cell_of_side[side]] : nullptr;
}

void SideMeasurement::start(const ViewState& state, Measurand measurand) {
  cancel();
  remove_temporary_files(find_place(), is_gone);  // of a window that was killed
  folder_.emplace(make_temporary_folder_path(find_place(), "worker"));
  const fs::path experiment = folder_->path() / kExperimentName;
  save_scene(state, scene_beside(experiment));
  write_text_file(experiment, write_experiment(state, make_quick(state.options, measurand), experiment));
  results_ = list_cells(state, measurand);
  worker_.emplace(list_arguments(state.options, folder_->path(), measurand),
                  run::WorkerSetup{program_, kLowestPriority});
  if (!opening_.valid()) opening_ = std::async(std::launch::async, open_for_reading);
  text_ = "starting";
  state_ = State::kRunning;
}

SideMeasurement::State SideMeasurement::poll() {
  if (worker_ && worker_->listen({})) end_worker();
  if (worker_) {
    if (std::string step = find_step(worker_->error_text()); !step.empty()) text_ = std::move(step);
  }
  if (reading_.valid() && reading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) finish_reading();
  return state_;
}

void SideMeasurement::end_worker() {
  const run::WorkerOutcome outcome = worker_->end();
  worker_.reset();
  if (outcome.exit_code == 0) {
    text_ = "reading the results";
    reading_ = std::async(std::launch::async, read_results, std::move(results_), folder_->path() / kReportName,
                          std::cref(is_cancelled_));
    return;
  }
  text_ = explain(outcome);
  state_ = State::kFailed;
  remove_files();
}

void SideMeasurement::finish_reading() {
  try {
    results_ = reading_.get();
    text_.clear();
    state_ = State::kFinished;
  } catch (const std::exception& error) {
    text_ = error.what();
    state_ = State::kFailed;
  }
  remove_files();
}

void SideMeasurement::remove_files() {
  if (!folder_) return;
  folder_.reset();
  std::error_code in_use;  // by another window
  fs::remove(find_place(), in_use);
}

void SideMeasurement::cancel() {
  worker_.reset();
  is_cancelled_ = true;
  if (reading_.valid()) reading_.wait();  // for one image at most
  reading_ = {};
  is_cancelled_ = false;
  remove_files();
  results_ = {};
  text_.clear();
  state_ = State::kIdle;
}

}  // namespace shadowbench::view
