#include "harness/gpu/gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "base/text.h"
#include "base/toml.h"
#include "report/records/records.h"

namespace shadowbench::gpu {
namespace {

/// The numbers that a constant may be.
Range find_range(std::string_view key) {
  if (key.starts_with("rate_")) return {1e-3, 1.0};
  if (key == "line_bytes") return {16.0, 4096.0};
  return {1e-3, 1e6};
}

Constant read_constant(const TomlTable& file, const char* key) {
  const auto table = file.table(key);
  if (!table) throw file.error(key, fmt::format("the table [{}] is missing; it holds a value and its source", key));
  table->require_known_keys({"value", "source"});
  return {table->number("value", find_range(key)), table->string("source")};
}

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

Gpu load_gpu(const std::filesystem::path& file) {
  const TomlTable table = read_toml(file, "the GPU's file");
  Gpu gpu;
  std::vector<std::string> keys = {"title", "driver"};
  visit_constants(gpu, [&](const char* key, const Constant&) { keys.emplace_back(key); });
  table.require_known_keys(keys);
  gpu.name = file.stem().string();
  gpu.title = table.string("title");
  gpu.families = table.strings("driver");
  if (gpu.families.empty()) throw table.find("driver")->must_be("a string or a list of strings");
  visit_constants(gpu, [&](const char* key, Constant& constant) { constant = read_constant(table, key); });
  const double line = gpu.line_bytes.value;
  if (line != std::floor(line) || !std::has_single_bit(static_cast<unsigned>(line)))
    throw table.table("line_bytes")->error("value", fmt::format("'value' is {}; a line has a power of two", line));
  return gpu;
}

std::vector<Gpu> load_gpus(const std::filesystem::path& folder) {
  std::vector<Gpu> gpus;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") gpus.push_back(load_gpu(entry.path()));
  std::ranges::sort(gpus, {}, &Gpu::name);
  return gpus;
}

std::vector<Gpu> choose_gpus(const std::vector<Gpu>& all, const std::vector<std::string>& names) {
  if (names == std::vector<std::string>{"none"}) return {};
  std::vector<std::string> known = {"none"};
  for (const Gpu& gpu : all) known.push_back(gpu.name);
  std::vector<Gpu> chosen;
  for (const std::string& name : names) {
    if (name == "none") throw Error(ErrorKind::kUsage, "--gpu: 'none' stands alone; leave it out beside other names");
    const auto found = std::ranges::find(all, name, &Gpu::name);
    if (found == all.end())
      throw Error(ErrorKind::kUsage, fmt::format("--gpu: '{}' is no GPU that is described{}; {}", name,
                                                 did_you_mean_or_known(name, known), kOtherGpus));
    if (std::ranges::find(chosen, name, &Gpu::name) != chosen.end())
      throw Error(ErrorKind::kUsage, fmt::format("--gpu: '{}' is named twice; name each GPU once", name));
    chosen.push_back(*found);
  }
  return chosen;
}

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
