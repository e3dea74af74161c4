#pragma once

#include <stdexcept>

#include "report/records/description.h"
#include "report/records/gpu_frame.h"
#include "report/records/records.h"

namespace shadowbench::records {

inline constexpr About kPositive{.least = 0};

// What a cell costs on GPUs that were not there; see record_fields.h.

void visit_fields(Is<ShaderFacts> auto& facts, auto&& visit) {
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

void visit_fields(Is<GpuPassRecord> auto& pass, auto&& visit) {
  visit("pass", pass.pass, {.filled = true});
  visit("draws", pass.draws, {.text = "for one map", .least = 1});
  visit_fields(pass.facts, visit);
}

/// Visits the parts of an estimate alone: what bounds it stands beside them, in the record of the GPU.
void visit_fields(Is<GpuEstimateRecord> auto& parts, auto&& visit) {
  visit("lookup", parts.lookup_us, kPositive);
  visit("prefilter", parts.prefilter_us, kPositive);
  visit("map", parts.map_us, kPositive);
  visit("arithmetic", parts.arithmetic_us, kPositive);
  visit("sampling", parts.sampling_us, kPositive);
  visit("memory", parts.memory_us, kPositive);
}

void visit_fields(Is<GpuRecord> auto& gpu, auto&& visit) {
  const auto& estimate = gpu.estimate;
  const auto cost = [&](bool is_moving) {
    return estimate ? std::optional(frame_ms(*estimate, is_moving)) : std::nullopt;
  };
  std::optional<double> moving = cost(true), still = cost(false);  // files hold them for their readers; they follow
  std::optional<std::string> bound_by = estimate ? std::optional(estimate->bound_by) : std::nullopt;
  std::optional<std::string> refused = null_if_empty(gpu.refused);
  visit("facts", gpu.facts);
  visit("frame_ms", kGroup,
        {.text = "of a frame of 1920x1080, each pixel a lookup, with one map; moving: with its prefilter and a lower "
                 "bound of drawing it. What every lookup pays is left out"});
  visit("frame_ms.moving", moving, {.least = 0});
  visit("frame_ms.static", still, {.least = 0});
  visit("parts_us", gpu.estimate,
        {.text = "lookup is of a million receivers, as dense as in that frame, and the largest of arithmetic, sampling "
                 "and memory, which is null where the filter's reads are not known; prefilter is of one map; map is a "
                 "lower bound of drawing it, from its triangles and texels"});
  visit("bound_by", bound_by, {.one_of = "arithmetic,sampling,memory"});
  visit("refused", refused);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(gpu)>>) {
    gpu.refused = refused.value_or("");
    if (gpu.estimate && !bound_by) throw std::invalid_argument("an estimate with what bounds it");
    if (gpu.estimate) gpu.estimate->bound_by = *bound_by;
  }
}

}  // namespace shadowbench::records
