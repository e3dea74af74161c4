#include "report/analysis/gpu_costs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

const records::ShaderFacts* find_facts(const records::GpuRecord& record, const char* pass) {
  const auto found = std::ranges::find(record.facts, pass, &records::GpuPassRecord::pass);
  return found == record.facts.end() ? nullptr : &found->facts;
}

int count_loops(const records::GpuRecord& record) {
  int loops = 0;
  for (const records::GpuPassRecord& pass : record.facts) loops += pass.facts.loops;
  return loops;
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
      cost.lookup_ms += records::frame_ms(estimate, false) / count;
      cost.prefilter_ms += 1e-3 * estimate.prefilter_us / count;
      cost.map_ms += 1e-3 * estimate.map_us / count;
    }
    costs.push_back(cost);
  }
  return costs;
}

std::vector<std::string> describe_gpu(const std::string& gpu, const std::vector<GpuCost>& costs) {
  std::vector<std::string> sentences;
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
