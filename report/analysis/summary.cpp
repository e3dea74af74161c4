#include "report/analysis/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

std::string describe_experiment(const records::ExperimentRecord& experiment) {
  std::string text =
      fmt::format("{}{}{} cells", experiment.title, experiment.title.empty() ? "" : " · ", experiment.cells);
  if (experiment.shards > 1) text += fmt::format(", shard {} of {}", experiment.shard, experiment.shards);
  return text;
}

std::string describe_work(const records::WorkRecord& work) {
  std::string text = fmt::format(
      "{} shader variants compiled, {} passes run, {} passes skipped because no filter needed them, "
      "{} truths ray traced, {} truths read from the cache; {} s of timed passes in {} s",
      work.shader_variants_compiled, work.passes_run, work.passes_skipped, work.truths_traced, work.truths_cached,
      records::format_number(work.timed_s), records::format_number(work.elapsed_s));
  if (work.attribution_s)
    text += fmt::format(", of which attribution took {} s", records::format_number(*work.attribution_s));
  return text;
}

using Facts = std::vector<std::pair<std::string, std::string>>;

}  // namespace

Facts list_run_facts(const records::RunRecord& run) {
  return {{"experiment", describe_experiment(run.experiment)},
          {"command", fmt::format("{}", fmt::join(run.command, " "))},
          {"commit", run.commit},
          {"seed", fmt::format("{}", run.seed)},
          {"times", records::describe_clock(run.gl)},
          {"GL", fmt::format("{} · {} · {}", run.gl.backend, run.gl.renderer, run.gl.version)},
          {"machine", fmt::format("{} · {} cores · load {} at the start", run.machine.cpu, run.machine.cores,
                                  records::format_number(run.machine.load_at_start))},
          {"system", fmt::format("{} · {}", run.machine.os, run.machine.compiler)},
          {"work", describe_work(run.work)}};
}

std::string warn_of_mixed_machines(const std::vector<records::CellRecord>& cells) {
  std::map<std::string, int> kinds;
  for (const records::CellRecord& cell : cells)
    ++kinds[cell.machine ? records::describe_machine_kind(*cell.machine) : "one that the cells do not name"];
  std::vector<std::string> names;
  for (const auto& [kind, count] : kinds)
    names.push_back(fmt::format("{} ({} cell{})", kind, count, count == 1 ? "" : "s"));
  return fmt::format(
      "{}: {}. Times from different machines do not compare, and are left out; timings.csv has them. Costs are "
      "estimates for GPUs, where the run has any; fetches and bytes depend on no machine.",
      kMixedMachines, fmt::join(names, "; "));
}

std::map<std::string, int> count_absences(const std::vector<records::CellRecord>& cells) {
  std::map<std::string, int> counts;
  for (const records::CellRecord& cell : cells)
    for (const auto& [field, reason] : cell.absent) ++counts[field + ": " + reason];
  return counts;
}

}  // namespace shadowbench::analysis
