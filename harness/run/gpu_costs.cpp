#include "harness/run/gpu_costs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "base/files.h"
#include "harness/gpu/gpu.h"
#include "harness/run/worker_process.h"

namespace shadowbench::run {
namespace {

/// How long one process may compile.
constexpr double kTimeout_s = 60.0;

std::string name_pass(const render::DrawnPass& pass) {
  return std::string(pass.target.name) + "\n" + pass.fragment.text;
}

std::vector<const render::DrawnPass*> list_passes(const measure::MeasuredCell& cell) {
  std::vector<const render::DrawnPass*> passes = {&cell.empty_lookup};
  for (const render::DrawnPass& pass : cell.passes) passes.push_back(&pass);
  return passes;
}

/// Whether RADV ended the process because it does not know the family that it was to compile for.
bool is_unknown(const WorkerOutcome& outcome) { return outcome.error_text.find("Unknown family") != std::string::npos; }

/// With what the driver said, if anything.
std::string describe_end(const WorkerOutcome& outcome) {
  if (outcome.timed_out) return fmt::format("the driver did not finish in {:g} s", kTimeout_s);
  return fmt::format("the driver crashed: signal {} ({}): {}", outcome.signal, strsignal(outcome.signal),
                     clean_message(outcome.error_text));
}

gpu::Reads find_reads(const render::FilterCost& cost, const records::ShaderFacts& lookup,
                      const records::ShaderFacts& empty) {
  if (cost.fetches) return {*cost.fetches - cost.fetches_64 - cost.fetches_128, cost.fetches_64, cost.fetches_128};
  // A filter that reads samplers itself is not counted while it draws: what stands in its code is what there is.
  return {static_cast<double>(std::max(0, lookup.reads() - empty.reads())), 0.0, 0.0};
}

}  // namespace

bool GpuCosts::compile(const std::vector<measure::MeasuredCell>& cells) {
  for (const gpu::Gpu& gpu : options_.gpus)
    if (!refused_.contains(gpu.name)) compile(gpu, cells);
  return refused_.size() < options_.gpus.size();
}

void GpuCosts::add_to(std::vector<measure::MeasuredCell>& cells) {
  for (const gpu::Gpu& gpu : options_.gpus) {
    for (measure::MeasuredCell& cell : cells) {
      if (cell.passes.empty()) continue;
      if (!cell.record.gpu) cell.record.gpu.emplace();
      records::GpuRecord& record = (*cell.record.gpu)[gpu.name] = make_record(gpu, cell);
      if (!record.refused.empty())
        cell.record.absent["gpu." + gpu.name] = record.refused;
      else if (!record.estimate)
        cell.record.absent["gpu." + gpu.name + ".frame_ms"] =
            cell.cost.fetches ? "the map has no receiver in view"
                              : "the filter reads the map's samplers itself, so that its reads are not counted";
    }
  }
  if (!options_.gpus.empty()) return;
  for (measure::MeasuredCell& cell : cells) cell.record.absent["gpu"] = "the run was made with --gpu none";
}

std::optional<std::string> find_family(const gpu::Gpu& gpu) {
  const ScratchFolder folder(make_temporary_folder_path(std::filesystem::temp_directory_path() / "shadowbench", "gpu"));
  const auto request = folder.path() / "request.json", answers = folder.path() / "answers.json";
  for (const std::string& family : gpu.families) {
    gpu::write_request(request, {family, {}, {}});
    if (run_worker({"gpu-facts", request.string(), answers.string()}, kTimeout_s).exit_code == 0) return family;
  }
  return std::nullopt;
}

/// After a crash the passes behind the one that crashed are given to a new process; after two that gave no answer at
/// all, none is.
void GpuCosts::compile(const gpu::Gpu& gpu, const std::vector<measure::MeasuredCell>& cells) {
  Answers& known = answers_[gpu.name];
  std::map<std::string, const render::DrawnPass*> wanted;
  for (const measure::MeasuredCell& cell : cells) {
    if (cell.passes.empty()) continue;
    for (const render::DrawnPass* pass : list_passes(cell))
      if (const std::string name = name_pass(*pass); !known.contains(name)) wanted.emplace(name, pass);
  }
  const auto refuse = [&](const std::string& why) {
    refused_[gpu.name] = why;
    note_(fmt::format("note: no costs on {}: {}", gpu.name, why));
  };
  if (wanted.empty()) return;
  bool was_silent = false;  // the process before gave no answer at all
  std::string family = gpu.families.front();
  const ScratchFolder folder(make_temporary_folder_path(options_.out, "gpu"));
  while (!wanted.empty()) {
    const auto request = folder.path() / fmt::format("{}.request.json", wanted.size());
    const auto answers = folder.path() / fmt::format("{}.answers.json", wanted.size());
    gpu::FactsRequest asked{family, options_.cache, {}};
    for (const auto& [name, pass] : wanted) asked.passes.push_back({pass->fragment, std::string(pass->target.name)});
    gpu::write_request(request, asked);
    const WorkerOutcome outcome = run_worker({"gpu-facts", request.string(), answers.string()}, kTimeout_s);
    if (outcome.exit_code.value_or(0) != 0) return refuse(clean_message(outcome.error_text));
    if (is_unknown(outcome)) {
      const std::optional<std::string> known_family = find_family(gpu);
      if (!known_family || *known_family == family)
        return refuse(
            fmt::format("this machine's Vulkan driver does not know {}; 'list gpus --check' shows what it knows",
                        fmt::join(gpu.families, " or ")));
      family = *known_family;
      continue;
    }
    std::vector<gpu::FactsAnswer> given = gpu::read_answers(answers);
    if (given.empty() && was_silent) return refuse(describe_end(outcome));
    was_silent = given.empty();
    for (gpu::FactsAnswer& answer : given) {
      if (wanted.empty()) break;
      known.emplace(wanted.begin()->first, std::move(answer));
      wanted.erase(wanted.begin());
    }
    if (wanted.empty()) return;
    known.emplace(wanted.begin()->first, gpu::FactsAnswer{{}, describe_end(outcome)});
    wanted.erase(wanted.begin());
  }
}

records::GpuRecord GpuCosts::make_record(const gpu::Gpu& gpu, const measure::MeasuredCell& cell) const {
  records::GpuRecord record;
  if (const auto refused = refused_.find(gpu.name); refused != refused_.end()) {
    record.refused = refused->second;
    return record;
  }
  gpu::FilterWork work;
  for (const render::DrawnPass* pass : list_passes(cell)) {
    const gpu::FactsAnswer& answer = answers_.at(gpu.name).at(name_pass(*pass));
    if (!answer.refused.empty()) {
      record.facts.clear();
      record.refused = fmt::format("{}: {}", pass->name, answer.refused);
      return record;
    }
    record.facts.push_back({pass->name, pass->draws, answer.facts});
    if (pass == &cell.empty_lookup)
      work.empty = answer.facts;
    else if (pass == &cell.passes.front())
      work.lookup = answer.facts;
    else if (pass->is_screen)
      work.screen.push_back(
          {answer.facts, static_cast<double>(pass->draws), pass->target.bytes_per_texel, pass->read_bytes});
    else
      work.prefilter.push_back(
          {answer.facts, static_cast<double>(pass->texels), pass->target.bytes_per_texel, pass->read_bytes});
  }
  work.map = {cell.map_triangles, cell.record.coverage.map_filled.value_or(0.0) *
                                      static_cast<double>(cell.light.size()) * cell.record.map_size *
                                      cell.record.map_size};
  work.reads = find_reads(cell.cost, work.lookup, work.empty);
  const auto place = std::ranges::find(options_.gpus, gpu.name, &gpu::Gpu::name) - options_.gpus.begin();
  if (!cell.fetched_bytes.empty()) work.memory_bytes = cell.fetched_bytes[static_cast<std::size_t>(place)];
  if (work.memory_bytes) record.estimate = gpu::estimate(gpu, work);
  return record;
}

}  // namespace shadowbench::run
