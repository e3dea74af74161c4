#include "report/records/gpu_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uintmax_t kMostBytes = 16 * kMebibyte;
constexpr const char* kAdvice = "choose a gpu-times.json that a report's page saved";
constexpr const char* kSchema = "shadowbench gpu-times 1";  // report/document/live/machine_times.js writes it

[[noreturn]] void refuse(const fs::path& file, const std::string& what) {
  fail_input(fmt::format("{}; {}", what, kAdvice), file.string());
}

/// What the file has of a part, ms.
struct FilePart {
  double median = 0.0;
  std::optional<Interval> interval;
  int rounds = 0;
};

void visit_fields(FilePart& part, auto&& visit) {
  visit("median", part.median);
  visit("interval", part.interval);
  visit("rounds", part.rounds);
}

OwnTime to_time(const FilePart& part) {
  const Interval ci95 = part.interval.value_or(Interval{part.median, part.median});
  for (const double each : {part.median, ci95.low, ci95.high}) require(std::abs(each) < 1e9, "a number in range");
  require(part.rounds > 0, "one round or more");
  return {{part.median, ci95.low, ci95.high, part.rounds}, ci95};
}

/// What a file has of a cell.
TimedParts read_times(const json& cell) {
  const auto read = [&](const char* part) { return to_time(read_value<FilePart>(cell.at(part))); };
  const auto read_if = [&](const char* part) {
    return cell.at(part).is_null() ? std::nullopt : std::optional(read(part));
  };
  return {read_if("map"), read_if("prefilter"), read("filter")};
}

void add(OwnTime& sum, const OwnTime& part) {
  sum.median += part.median;
  sum.q1 += part.q1;
  sum.q3 += part.q3;
  sum.n = std::min(sum.n, part.n);
  sum.ci95.low += part.ci95.low;
  sum.ci95.high += part.ci95.high;
}

void set_times(CellRecord& cell, const TimedParts& parts) {
  cell.time_ms = {};
  if (parts.map) cell.time_ms.map = *parts.map;
  if (parts.prefilter) cell.time_ms.prefilter = *parts.prefilter;
  cell.time_ms.lookup = parts.filter;
  cell.time_ms.static_light = parts.filter;
  if (!parts.map) return;
  OwnTime moving = *parts.map;
  if (parts.prefilter) add(moving, *parts.prefilter);
  add(moving, parts.filter);
  cell.time_ms.moving = moving;
}

}  // namespace

GpuTimes read_gpu_times(const fs::path& file) {
  const json written = read_json_file(file, kMostBytes, kAdvice);
  if (!written.is_object() || written.value("schema", json()) != kSchema)
    refuse(file, fmt::format("its schema is not \"{}\"", kSchema));
  GpuTimes times;
  times.file = file;
  std::string key;
  try {
    times.renderer = written.at("renderer").get<std::string>();
    times.software = written.value("isSoftware", false);
    for (const auto& [name, cell] : written.at("cells").items()) {
      key = name;
      times.cells[name] = read_times(cell);
    }
  } catch (const std::exception&) {
    refuse(file, key.empty() ? "it has no renderer or no cells"
                             : fmt::format("what it has of the cell {} is no time of map, prefilter and filter", key));
  }
  return times;
}

void apply_gpu_times(Results& results, const GpuTimes& times) {
  const auto is_timed = [&](const CellRecord& cell) { return times.cells.contains(cell.key); };
  if (std::ranges::none_of(results.cells, is_timed))
    refuse(times.file, "it has times of another run: none of its cells is one of this one");
  results.run.gl.renderer = times.renderer;
  results.run.gl.software = times.software;
  for (CellRecord& cell : results.cells) {
    cell.ratio_to_none = {};
    cell.machine = MachineKind{"", 0, times.renderer, times.software, TimerKind::kWallClock};
    const auto found = times.cells.find(cell.key);
    if (found == times.cells.end()) {
      cell.time_ms = {};
      cell.absent["time_ms"] = fmt::format("{} did not time it", times.renderer);
      continue;
    }
    set_times(cell, found->second);
  }
}

}  // namespace shadowbench::records
