#include "report/analysis/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/analysis/accuracy_words.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/limits.h"
#include "report/analysis/ranking.h"
#include "report/analysis/repeat.h"
#include "report/analysis/stability_words.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

std::string join_tied(const CellGroup& group, const std::vector<std::size_t>& indices) {
  std::vector<std::string> names;
  for (const std::size_t i : indices) names.push_back(label_cell(group, group.cells[i]));
  return fmt::format("{}", fmt::join(names, " tied with "));
}

std::string describe_ranking(const CellGroup& group, const std::vector<std::vector<std::size_t>>& ranks) {
  std::string text = "With a moving light, cheapest first: ";
  for (std::size_t i = 0; i < ranks.size(); ++i) text += (i > 0 ? "; then " : "") + join_tied(group, ranks[i]);
  return text + ".";
}

std::string describe_extremes(const CellGroup& group, const records::CellRecord& cheapest,
                              const records::CellRecord& dearest, const records::GlRecord& gl) {
  const auto ms = [](const records::CellRecord& cell) {
    return records::format_number(frame_time(cell, LightMotion::kMoving)->median);
  };
  std::string text = fmt::format("In {}, {} costs {} ms a frame", records::describe_clock(gl),
                                 label_cell(group, cheapest), ms(cheapest));
  if (&cheapest != &dearest) text += fmt::format(", {} {} ms", label_cell(group, dearest), ms(dearest));
  return text + ": map, prefilter and lookup, less a lookup that reads nothing.";
}

std::vector<std::string> describe_prefilters(const CellGroup& group, const records::GlRecord& gl) {
  std::vector<std::string> parts;
  for (const records::CellRecord& cell : group.cells) {
    if (cell.time_ms.prefilter) {
      parts.push_back(fmt::format("{} {} {}", label_cell(group, cell),
                                  records::format_number(cell.time_ms.prefilter->median), records::time_unit(gl)));
    }
  }
  if (parts.empty()) return {};
  return {fmt::format("Of that the prefilter, paid again whenever the map changes: {}.", fmt::join(parts, ", "))};
}

std::vector<std::string> describe_troubles(const CellGroup& group) {
  std::vector<std::string> sentences;
  for (const records::CellRecord& cell : group.cells) {
    if (!records::is_drawn(cell))
      sentences.push_back(
          fmt::format("{} did not finish ({}).", label_cell(group, cell), records::describe_status(cell)));
    if (cell.status == records::CellStatus::kSuspect)
      sentences.push_back(fmt::format("{} is left out of rankings, fronts, advice and common scales, for it is {}.",
                                      label_cell(group, cell), records::describe_status(cell)));
    if (cell.nan.value_or(0) > 0)
      sentences.push_back(fmt::format("{} has {} pixels that are not finite.", label_cell(group, cell), *cell.nan));
  }
  return sentences;
}

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

}  // namespace

std::vector<std::string> describe_group(const CellGroup& all, const records::GlRecord& gl) {
  std::vector<std::string> sentences;
  CellGroup group = all;
  std::erase_if(group.cells,
                [](const records::CellRecord& cell) { return cell.status == records::CellStatus::kSuspect; });
  const auto ranks = rank_costs(group.cells);
  if (!ranks.empty()) {
    sentences.push_back(describe_ranking(group, ranks));
    sentences.push_back(
        describe_extremes(group, group.cells[ranks.front().front()], group.cells[ranks.back().back()], gl));
  }
  const std::string coverage = records::describe_coverage(all.cells.front().coverage);
  if (!coverage.empty()) sentences.push_back("Over the receivers in view: " + coverage + ".");
  for (const auto& more :
       {describe_prefilters(group, gl), describe_accuracy(group), describe_stability(group), describe_troubles(all)})
    sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

std::vector<std::pair<std::string, std::string>> list_run_facts(const records::RunRecord& run) {
  std::vector<std::pair<std::string, std::string>> facts = {
      {"experiment", describe_experiment(run.experiment)},
      {"command", fmt::format("{}", fmt::join(run.command, " "))},
      {"commit", run.commit},
      {"seed", fmt::format("{}", run.seed)},
      {"times", records::describe_clock(run.gl)},
      {"GL", fmt::format("{} · {} · {}", run.gl.backend, run.gl.renderer, run.gl.version)},
      {"machine",
       fmt::format("{} · {} cores · load {} at the start", run.machine.cpu, run.machine.cores,
                   run.machine.load_at_start ? records::format_number(*run.machine.load_at_start) : records::kNothing)},
      {"system", fmt::format("{} · {}", run.machine.os, run.machine.compiler)},
      {"work", describe_work(run.work)}};
  if (run.repeat.of.value_or(0) > 0) {
    facts.emplace_back("repeat", fmt::format("{} those of the run that this one replaced ({} cells)",
                                             describe_overlap(run.repeat), run.repeat.cells.value_or(0)));
  }
  return facts;
}

std::map<std::string, int> count_absences(const std::vector<records::CellRecord>& cells) {
  std::map<std::string, int> counts;
  for (const records::CellRecord& cell : cells)
    for (const auto& [field, reason] : cell.absent) ++counts[field + ": " + reason];
  return counts;
}

}  // namespace shadowbench::analysis
