#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/gpu/facts_request.h"
#include "harness/measure/scene_measurement.h"
#include "harness/options/options.h"

namespace shadowbench::run {

/// The name by which this machine's Vulkan driver compiles for a GPU, asked in a process of its own for each name; none
/// where it knows none, or where there is no such driver.
std::optional<std::string> find_family(const gpu::Gpu& gpu);

/// What a run's filters cost on the GPUs that it names, by compiling their passes in a process of its own: a driver
/// that crashes costs the facts of one pass.
class GpuCosts {
 public:
  /// `note` hears, once, why a GPU has no facts. Both must outlive this object.
  GpuCosts(const options::RunOptions& options, const std::function<void(const std::string&)>& note)
      : options_(options), note_(note) {}

  /// Compiles the passes of cells. Says whether any GPU compiles at all.
  bool compile(const std::vector<measure::MeasuredCell>& cells);

  /// Fills the records' `gpu`. Requires that their passes were compiled. Cells that have no passes keep what they have:
  /// a user's filter brings its own.
  void add_to(std::vector<measure::MeasuredCell>& cells);

 private:
  using Answers = std::map<std::string, gpu::FactsAnswer>;  ///< by what the pass is made of

  const options::RunOptions& options_;
  const std::function<void(const std::string&)>& note_;
  std::map<std::string, Answers> answers_;      ///< by GPU
  std::map<std::string, std::string> refused_;  ///< by GPU: why it compiles nothing

  void compile(const gpu::Gpu& gpu, const std::vector<measure::MeasuredCell>& cells);

  records::GpuRecord make_record(const gpu::Gpu& gpu, const measure::MeasuredCell& cell) const;
};

}  // namespace shadowbench::run
