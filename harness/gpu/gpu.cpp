#include "harness/gpu/gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/text.h"
#include "base/toml.h"

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

}  // namespace shadowbench::gpu
