#include "report/analysis/findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "filters/store_format.h"
#include "reference/metrics/error_stats.h"
#include "report/analysis/cells.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

bool has_replicates(const records::CellRecord& cell) {
  return cell.status == records::CellStatus::kOk && cell.error.rmse && cell.rmse_replicates;
}

/// The differences that are found in four of five runs, for every two cells of one class, in the places of all groups.
std::vector<double> list_least_differences(const std::vector<records::CellRecord>& cells) {
  std::vector<double> differences;
  for (const CellGroup& group : group_cells(cells)) {
    for (std::size_t i = 0; i < group.cells.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const records::CellRecord &a = group.cells[i], &b = group.cells[k];
        if (!has_replicates(a) || !has_replicates(b) || !find_class(a) || find_class(a) != find_class(b)) continue;
        const std::size_t count = a.rmse_replicates->size();
        if (count != b.rmse_replicates->size()) continue;
        const Estimate gap = subtract(estimate_rmse(a), estimate_rmse(b));
        const double power = metrics::find_student_t(count, 0.8) / metrics::find_student_t(count);
        differences.push_back((gap.high - gap.value) * (1.0 + power));
      }
    }
  }
  return differences;
}

}  // namespace

std::string describe_power(const std::vector<records::CellRecord>& cells) {
  std::vector<double> differences = list_least_differences(cells);
  if (differences.empty()) return {};
  std::ranges::sort(differences);
  const auto at = [&](double share) {
    const auto place = static_cast<std::size_t>(share * static_cast<double>(differences.size()));
    return records::format_number(differences[place]);
  };
  return fmt::format(
      "Smallest detectable RMSE difference (80 % power, {} sub-texel offsets of the map): {} in half of the {} pairs "
      "of "
      "one class and scene, {} in nine of ten.",
      std::ranges::find_if(cells, has_replicates)->phases.value_or(0), at(0.5), differences.size(), at(0.9));
}

namespace {

constexpr double kVisibleDifference = 1.0 / 255.0;  // of visibility: one step of a picture

double count_texels(const records::CellRecord& cell) {
  return static_cast<double>(cell.map_size) * static_cast<double>(cell.map_size);
}

std::string share_of_map(const records::CellRecord& cell, std::int64_t texels) {
  return records::format_number(100.0 * static_cast<double>(texels) / count_texels(cell)) + " % of its map's texels";
}

std::int64_t count_broken(const records::StabilityRecord& s) {
  return s.overflow_texels.value_or(0) + s.nan_texels.value_or(0);
}

/// "r16f holds numbers up to 65504 (e^11.09)"; empty where the cell has no store.
std::string describe_limit(const records::CellRecord& cell) {
  const auto found = cell.params.find("store");
  if (found == cell.params.end() || !std::holds_alternative<std::string>(found->second)) return {};
  const auto& store = std::get<std::string>(found->second);
  const double largest = filters::largest_number(filters::store_precision(store));
  return fmt::format("{} holds numbers up to {:.6g} (e^{:.2f})", store, largest, std::log(largest));
}

std::string describe_overflow(const records::CellRecord& cell) {
  std::string text = fmt::format("{} overflowed", share_of_map(cell, count_broken(cell.stability)));
  const std::string limit = describe_limit(cell);
  if (!limit.empty()) text += ": " + limit;
  if (cell.stability.safe_exponent)
    text += fmt::format("; an exponent of {:.4g} is safe here", *cell.stability.safe_exponent);
  return text;
}

std::string describe_variance(const records::CellRecord& cell) {
  return fmt::format("the variance of {} is below 0 before the clamp, down to {:.2g}",
                     share_of_map(cell, *cell.stability.negative_variance_texels),
                     cell.stability.lowest_variance.value_or(0.0));
}

std::string describe_bound(const records::StabilityRecord& s) {
  std::string text = fmt::format(
      "darker than the percentage-closer filter that it bounds, by up to {}; at {} receivers by more than rounding "
      "explains",
      records::format_number(*s.bound_shortfall_max), s.bound_violations.value_or(0));
  if (s.bound_exact_violations.value_or(0) > 0) {
    text += fmt::format(", and at {} in exact arithmetic too: with these parameters it is no bound",
                        *s.bound_exact_violations);
  }
  return text;
}

std::vector<std::string> list_troubles(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  std::vector<std::string> troubles;
  if (count_broken(s) > 0) troubles.push_back(describe_overflow(cell));
  if (s.negative_variance_texels.value_or(0) > 0) troubles.push_back(describe_variance(cell));
  if (s.half_difference_max.value_or(0.0) > kVisibleDifference) troubles.push_back(caption_difference(cell));
  if (s.bound_violations.value_or(0) > 0 || s.bound_shortfall_max.value_or(0.0) > kVisibleDifference)
    troubles.push_back("it is " + describe_bound(s));
  return troubles;
}

}  // namespace

std::vector<std::string> describe_stability(const CellGroup& group) {
  std::vector<std::string> sentences;
  for (const records::CellRecord& cell : group.cells)
    for (const std::string& trouble : list_troubles(cell))
      sentences.push_back(fmt::format("{}: {}.", group.names.name(cell), trouble));
  return sentences;
}

std::string caption_texels(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  if (!s.overflow_texels) return {};
  if (count_broken(s) > 0) return describe_overflow(cell) + " · magenta: overflow";
  std::string text = describe_limit(cell);
  if (s.headroom) text += fmt::format(" · {} left at the largest texel", records::format_number(*s.headroom));
  if (s.safe_exponent) text += fmt::format(" · safe up to an exponent of {:.4g}", *s.safe_exponent);
  return text;
}

std::string caption_variance(const records::CellRecord& cell) {
  if (!cell.stability.negative_variance_texels) return {};
  if (*cell.stability.negative_variance_texels == 0) return "red: below 0, which no texel is";
  return describe_variance(cell) + " · red: below 0";
}

std::string caption_difference(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  if (!s.half_difference_max || !s.half_difference_rms) return {};
  return fmt::format("the 16-bit store's visibility is up to {} off that of the 32-bit store (RMS {})",
                     records::format_number(*s.half_difference_max), records::format_number(*s.half_difference_rms));
}

std::string caption_bound(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  if (!s.bound_shortfall_max) return {};
  if (*s.bound_shortfall_max <= 0.0) return "kept at every receiver";
  return describe_bound(s) + " · magenta: that";
}

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
