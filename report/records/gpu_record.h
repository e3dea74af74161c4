#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::records {

/// What a GPU's compiler says of one shader. Nothing here is measured; counts are of the machine code, in which the
/// body of a loop stands once. Source: the Vulkan extension VK_KHR_pipeline_executable_properties.
struct ShaderFacts {
  int instructions = 0;
  int code_bytes = 0;
  int vector_registers = 0;   ///< of each lane
  int scalar_registers = 0;   ///< of each wave
  int spilled_registers = 0;  ///< that live in memory for want of room
  int scratch_bytes = 0;      ///< of that memory, of each wave
  int waves_per_simd = 0;     ///< that fit at once, as the driver counts them
  int latency_cycles = 0;     ///< of one wave alone, loops guessed at
  int busy_cycles = 0;        ///< of a SIMD for one wave of 64 among others: the inverse throughput, loops guessed at
  int samples = 0;            ///< reads with a sampler
  int compares = 0;           ///< reads with a sampler that compares
  int gathers = 0;            ///< reads of four texels at once, with or without comparison
  int loads = 0;              ///< reads of a texel without a sampler
  int loops = 0;

  bool operator==(const ShaderFacts&) const = default;
};

/// Calls `visit(name, value)` for every field of the facts.
template <class Facts, class Visitor>
void visit_facts(Facts& facts, Visitor&& visit) {
  visit("instructions", facts.instructions);
  visit("code_bytes", facts.code_bytes);
  visit("vector_registers", facts.vector_registers);
  visit("scalar_registers", facts.scalar_registers);
  visit("spilled_registers", facts.spilled_registers);
  visit("scratch_bytes", facts.scratch_bytes);
  visit("waves_per_simd", facts.waves_per_simd);
  visit("latency_cycles", facts.latency_cycles);
  visit("busy_cycles", facts.busy_cycles);
  visit("samples", facts.samples);
  visit("compares", facts.compares);
  visit("gathers", facts.gathers);
  visit("loads", facts.loads);
  visit("loops", facts.loops);
}

/// One pass of a filter.
struct GpuPassRecord {
  std::string pass;  ///< "lookup", "empty", "encode", "blur", or the name of a pass of the filter's own
  int draws = 1;     ///< how often it is drawn for one map
  ShaderFacts facts;
};

/// Microseconds that a written model makes of the facts; see harness/gpu/README.md.
struct GpuEstimateRecord {
  double total_us = 0.0;                           ///< lookup and prefilter
  double lookup_us = 0.0;                          ///< of a million receivers, less the empty lookup's arithmetic
  double prefilter_us = 0.0;                       ///< of the map, each of its passes
  double arithmetic_us = 0.0, sampling_us = 0.0;   ///< of the lookup: the largest of these three is its time
  std::optional<double> memory_us = std::nullopt;  ///< nothing where the reads of the filter are not known
  std::string bound_by;                            ///< what takes longest: "arithmetic", "sampling" or "memory"
};

/// What one filter costs on one GPU that need not be there.
struct GpuRecord {
  std::vector<GpuPassRecord> facts;  ///< empty where `refused` says why
  std::optional<GpuEstimateRecord> estimate = std::nullopt;
  std::string refused;  ///< empty where there are facts
};

/// By the GPU's name.
using GpuRecords = std::map<std::string, GpuRecord>;

}  // namespace shadowbench::records
