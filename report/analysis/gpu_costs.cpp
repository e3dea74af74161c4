#include "report/analysis/gpu_costs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>

#include "report/analysis/advice.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::analysis {
namespace {

std::optional<double> find_mean(const Configuration& configuration, const CostKind& kind) {
  const auto cost = measure_cost(configuration.cells, kind, LightMotion::kMoving);
  return cost ? std::optional(cost->mean) : std::nullopt;
}

/// The costs that were estimated and measured.
struct Pairs {
  std::vector<const GpuCost*> costs;
  std::vector<double> estimated, measured;
};

Pairs list_pairs(const std::vector<GpuCost>& costs) {
  Pairs pairs;
  for (const GpuCost& cost : costs) {
    if (!cost.estimate_ms || !cost.measured_ms) continue;
    pairs.costs.push_back(&cost);
    pairs.estimated.push_back(*cost.estimate_ms);
    pairs.measured.push_back(*cost.measured_ms);
  }
  return pairs;
}

/// The place of a value among values, the smallest first, counted from 1.
std::ptrdiff_t find_rank(const std::vector<double>& values, double value) {
  return 1 + std::ranges::count_if(
                 values, [&](double other) { return other < value; });
}

const records::ShaderFacts* find_facts(const records::GpuRecord& record, const char* pass) {
  const auto found = std::ranges::find(record.facts, pass, &records::GpuPassRecord::pass);
  return found == record.facts.end() ? nullptr : &found->facts;
}

int count_loops(const records::GpuRecord& record) {
  int loops = 0;
  for (const records::GpuPassRecord& pass : record.facts) loops += pass.facts.loops;
  return loops;
}

/// The filter that stands farthest apart in the two orders.
std::string describe_farthest(const Pairs& pairs) {
  std::size_t farthest = 0;
  std::ptrdiff_t most = 0;
  for (std::size_t i = 0; i < pairs.costs.size(); ++i) {
    const std::ptrdiff_t apart =
        std::abs(find_rank(pairs.estimated, pairs.estimated[i]) - find_rank(pairs.measured, pairs.measured[i]));
    if (apart <= most) continue;
    most = apart;
    farthest = i;
  }
  if (most == 0) return "";
  return fmt::format(" Farthest apart is {}: number {} here, cheapest first, and {} there.",
                     pairs.costs[farthest]->configuration->name, find_rank(pairs.measured, pairs.measured[farthest]),
                     find_rank(pairs.estimated, pairs.estimated[farthest]));
}

/// The configurations whose estimates are within a hundredth of one of them, and that the same resource bounds: of
/// several such groups the largest, of three at least.
std::vector<const GpuCost*> find_level_group(const std::vector<GpuCost>& costs) {
  std::vector<const GpuCost*> largest;
  for (const GpuCost& first : costs) {
    std::vector<const GpuCost*> group;
    for (const GpuCost& other : costs) {
      const bool is_level = first.estimate_ms && other.estimate_ms && *other.estimate_ms >= *first.estimate_ms &&
                            *other.estimate_ms <= 1.01 * *first.estimate_ms;
      if (is_level && other.record->estimate->bound_by == first.record->estimate->bound_by) group.push_back(&other);
    }
    if (group.size() > largest.size()) largest = group;
  }
  if (largest.size() < 3) largest.clear();
  return largest;
}

}  // namespace

std::vector<GpuCost> list_gpu_costs(const std::vector<Configuration>& configurations, const std::string& gpu) {
  std::vector<GpuCost> costs;
  for (const Configuration& configuration : configurations) {
    const auto& records = configuration.cells.front()->gpu;
    const auto is_ok = [](const records::CellRecord* cell) { return cell->status == records::CellStatus::kOk; };
    if (!records || !records->contains(gpu) || !std::ranges::all_of(configuration.cells, is_ok)) continue;
    GpuCost cost;
    cost.configuration = &configuration;
    cost.record = &records->at(gpu);
    cost.estimate_ms = find_mean(configuration, {CostKind::kGpu, gpu});
    const auto is_of_cpu = [](const records::CellRecord* cell) { return cell->machine && cell->machine->software; };
    if (std::ranges::none_of(configuration.cells, is_of_cpu))
      cost.measured_ms = find_mean(configuration, CostKind::kTime);
    for (const records::CellRecord* cell : configuration.cells) {
      if (!cost.estimate_ms) break;
      const records::GpuEstimateRecord& estimate = *cell->gpu->at(gpu).estimate;
      const auto count = static_cast<double>(configuration.cells.size());
      const GpuResources alone = {estimate.arithmetic_us, estimate.sampling_us, estimate.memory_us.value_or(0.0)};
      const auto slowest = static_cast<std::size_t>(std::ranges::max_element(alone) - alone.begin());
      const double lookup = records::frame_ms(estimate, false);
      for (std::size_t i = 0; i < alone.size(); ++i) cost.alone_ms[i] += records::lookups_ms(alone[i]) / count;
      cost.slowest_ms[slowest] += lookup / count;
      cost.lookup_ms += lookup / count;
      cost.prefilter_ms += 1e-3 * estimate.prefilter_us / count;
      cost.map_ms += 1e-3 * estimate.map_us / count;
    }
    costs.push_back(cost);
  }
  return costs;
}

std::optional<double> correlate_ranks(const std::vector<GpuCost>& costs) {
  const Pairs pairs = list_pairs(costs);
  const std::size_t count = pairs.costs.size();
  if (count < 3) return std::nullopt;
  std::vector<double> work(2 * count);
  const double correlation =
      gsl_stats_spearman(pairs.estimated.data(), 1, pairs.measured.data(), 1, count, work.data());
  return std::isfinite(correlation) ? std::optional(correlation) : std::nullopt;
}

std::vector<std::string> describe_gpu(const std::string& gpu, const std::vector<GpuCost>& costs) {
  std::vector<std::string> sentences;
  const Pairs pairs = list_pairs(costs);
  if (const auto correlation = correlate_ranks(costs)) {
    sentences.push_back(
        fmt::format("{}: over {} configurations, the rank correlation of estimates and times here (moving light) is "
                    "{:.2f}.{}",
                    gpu, pairs.costs.size(), *correlation, describe_farthest(pairs)));
  }
  if (const auto level = find_level_group(costs); !level.empty()) {
    std::vector<std::string> names;
    for (const GpuCost* cost : level) names.push_back(cost->configuration->name);
    sentences.push_back(fmt::format("{}: {} cost the same, {} ms: what bounds them all is {}.", gpu,
                                    fmt::join(names, ", "), records::format_number(level.front()->estimate_ms),
                                    level.front()->record->estimate->bound_by));
  }
  std::vector<std::string> looped, spilled;
  for (const GpuCost& cost : costs) {
    const std::string& name = cost.configuration->name;
    if (!cost.record->refused.empty()) sentences.push_back(fmt::format("{}: {}: {}", gpu, name, cost.record->refused));
    if (count_loops(*cost.record) > 0) looped.push_back(name);
    const auto spills = [](const records::GpuPassRecord& pass) { return pass.facts.spilled_registers > 0; };
    if (std::ranges::any_of(cost.record->facts, spills)) spilled.push_back(name);
  }
  if (!looped.empty())
    sentences.push_back(
        fmt::format("{}: the compiler guesses how often loops turn: {}.", gpu, fmt::join(looped, ", ")));
  if (!spilled.empty())
    sentences.push_back(
        fmt::format("{}: registers spill to memory, which is slow: {}.", gpu, fmt::join(spilled, ", ")));
  return sentences;
}

records::TextTable make_gpu_table(const std::vector<GpuCost>& costs) {
  records::TextTable table;
  table.header = {"filter",   "estimate, ms",     "lookup, ms", "prefilter, ms", "map, ms at least",
                  "bound by", "own instructions", "own reads",  "registers",     "waves"};
  const bool is_measured = std::ranges::any_of(costs, [](const GpuCost& cost) { return cost.measured_ms.has_value(); });
  if (is_measured) table.header.insert(table.header.begin() + 2, "measured here, ms");
  std::vector<GpuCost> sorted = costs;
  std::ranges::stable_sort(sorted, {}, &GpuCost::estimate_ms);
  for (const GpuCost& cost : sorted) {
    const records::ShaderFacts* lookup = find_facts(*cost.record, "lookup");
    const records::ShaderFacts* empty = find_facts(*cost.record, "empty");
    if (!lookup || !empty || !cost.estimate_ms) continue;
    table.rows.push_back({cost.configuration->name, records::format_number(cost.estimate_ms),
                          records::format_number(cost.lookup_ms), records::format_number(cost.prefilter_ms),
                          records::format_number(cost.map_ms), cost.record->estimate->bound_by,
                          fmt::format("{}", lookup->instructions - empty->instructions),
                          fmt::format("{}", lookup->reads() - empty->reads()),
                          fmt::format("{}", lookup->vector_registers), fmt::format("{}", lookup->waves_per_simd)});
    std::vector<std::string>& row = table.rows.back();
    if (is_measured) row.insert(row.begin() + 2, records::format_number(cost.measured_ms));
  }
  return table;
}

}  // namespace shadowbench::analysis
