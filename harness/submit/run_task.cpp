#include "harness/submit/run_task.h"

#include <fmt/format.h>

#include <cstring>
#include <new>

#include "filters/base/error.h"
#include "harness/run/run_experiment.h"
#include "harness/submit/sign_of_life.h"
#include "harness/submit/sweep_folder.h"

namespace shadowbench::submit {
namespace {

/// The exit code of a process that a signal ends, as shells say it.
constexpr int kSignalCode = 128;
/// That of a bug.
constexpr int kBug = 70;

}  // namespace

void run_task(options::RunOptions options, const std::filesystem::path& folder, options::Progress& progress) {
  const SweepTask task = read_task(folder);
  const Sweep sweep = read_sweep(options.out);
  options.part = {task.kind == TaskKind::kTruth ? options::Product::kTruth : options::Product::kCells, task.ranges,
                  sweep.scene_cells, task.content};
  remove_failure(folder);
  const SignOfLife alive(folder);
  write_result(folder, run::run_experiment(options, progress));
}

void note_failed_task(const std::filesystem::path& folder, const std::exception& error) {
  const auto* known = dynamic_cast<const Error*>(&error);
  const bool lacks_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  const int code = known ? static_cast<int>(known->kind()) : lacks_memory ? static_cast<int>(ErrorKind::kInput) : kBug;
  try {
    if (std::filesystem::exists(folder)) write_failure(folder, {code, lacks_memory ? "memory ran out" : error.what()});
  } catch (const std::exception&) {
    // That it failed is said all the same, where the job prints.
  }
}

void note_stopped_task(const std::filesystem::path& folder, int signal) {
  remove_sign_of_life(folder);
  write_failure(folder, {kSignalCode + signal, fmt::format("stopped by signal {} ({})", signal, strsignal(signal))});
}

}  // namespace shadowbench::submit
