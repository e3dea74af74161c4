#include "harness/submit/engine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "filters/base/error.h"

namespace shadowbench::submit {
namespace {

struct EngineEntry {
  const char* name;
  std::unique_ptr<Engine> (*make)(const EngineOptions& options, const std::filesystem::path& out);
};

constexpr std::array<EngineEntry, 2> kEngines = {{{"slurm", make_slurm_engine}, {"parallel", make_parallel_engine}}};

}  // namespace

std::vector<std::string> list_engines() {
  std::vector<std::string> names;
  for (const EngineEntry& each : kEngines) names.emplace_back(each.name);
  return names;
}

std::unique_ptr<Engine> make_engine(const EngineOptions& options, const std::filesystem::path& out) {
  const auto found = std::ranges::find(kEngines, options.engine, &EngineEntry::name);
  if (found == kEngines.end())
    throw Error(ErrorKind::kUsage,
                fmt::format("--engine: '{}' must be one of {}", options.engine, fmt::join(list_engines(), ", ")));
  return found->make(options, out);
}

}  // namespace shadowbench::submit
