#include "harness/gpu/estimate.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "report/records/records.h"

namespace shadowbench::gpu {
namespace {

constexpr double kWave = 64.0;  // invocations that the compiler's cycles are of
constexpr double kMillion = 1e6;

/// Microseconds of one resource.
struct Part {
  std::string_view resource;
  double us = 0.0;
};

double arithmetic_us(const Gpu& gpu, double busy_cycles, double invocations) {
  return busy_cycles * invocations / (kWave * gpu.simds.value * gpu.clock_mhz.value);
}

double sampling_us(const Gpu& gpu, const Reads& reads, double invocations) {
  const double clocks = reads.of_32 + reads.of_64 / gpu.rate_64.value + reads.of_128 / gpu.rate_128.value;
  return clocks * invocations / (gpu.texture_units.value * gpu.clock_mhz.value);
}

double memory_us(const Gpu& gpu, double bytes) { return bytes / (gpu.memory_gb_s.value * 1e3); }

Part largest(const std::array<Part, 3>& parts) { return *std::ranges::max_element(parts, {}, &Part::us); }

Reads reads_of(const PrefilterWork& pass) {
  const double count = pass.facts.reads();
  if (pass.read_bytes <= 4) return {count, 0.0, 0.0};
  return pass.read_bytes <= 8 ? Reads{0.0, count, 0.0} : Reads{0.0, 0.0, count};
}

/// Everything that is read is read from memory once, and everything that is written goes there.
Part estimate_pass(const Gpu& gpu, const PrefilterWork& pass) {
  return largest({Part{"arithmetic", arithmetic_us(gpu, pass.facts.busy_cycles, pass.texels)},
                  Part{"sampling", sampling_us(gpu, reads_of(pass), pass.texels)},
                  Part{"memory", memory_us(gpu, pass.texels * (pass.written_bytes + pass.read_bytes))}});
}

}  // namespace

records::GpuEstimateRecord estimate(const Gpu& gpu, const FilterWork& work) {
  records::GpuEstimateRecord result;
  const double own_cycles = std::max(0, work.lookup.busy_cycles - work.empty.busy_cycles);
  result.arithmetic_us = arithmetic_us(gpu, own_cycles, kMillion);
  result.sampling_us = sampling_us(gpu, work.reads, kMillion);
  if (work.memory_bytes) result.memory_us = memory_us(gpu, *work.memory_bytes * kMillion);
  Part longest = largest({Part{"arithmetic", result.arithmetic_us}, Part{"sampling", result.sampling_us},
                          Part{"memory", result.memory_us.value_or(0.0)}});
  result.lookup_us = longest.us;
  for (PrefilterWork pass : work.screen) {
    pass.texels *= kMillion;
    const Part part = estimate_pass(gpu, pass);
    result.lookup_us += part.us;
    if (part.us > longest.us) longest = part;
  }
  longest.us = 1e3 * records::lookups_ms(longest.us);  // of a frame, beside the passes of its map
  for (const PrefilterWork& pass : work.prefilter) {
    const Part part = estimate_pass(gpu, pass);
    result.prefilter_us += part.us;
    if (part.us > longest.us) longest = part;
  }
  result.bound_by = longest.resource;
  result.map_us =
      std::max(work.map.triangles / gpu.triangles_per_clock.value, work.map.texels / gpu.pixels_per_clock.value) /
      gpu.clock_mhz.value;
  return result;
}

}  // namespace shadowbench::gpu
