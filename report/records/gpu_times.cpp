#include "report/records/gpu_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "report/files/file_name.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uintmax_t kMostBytes = 16 * kMebibyte;
constexpr const char* kFolder = "times";
constexpr const char* kSchema = "shadowbench gpu-times 1";  // report/document/live/machine_times.js writes it

[[noreturn]] void refuse(const fs::path& file, const std::string& what) {
  throw Error(ErrorKind::kInput, what + "; choose a gpu-times.json that a report's page saved", file.string());
}

double read_number(const json& value) {
  const double number = value.get<double>();
  if (!std::isfinite(number) || std::abs(number) >= 1e9) throw std::invalid_argument("a number is out of range");
  return number;
}

OwnTime read_time(const json& part) {
  OwnTime time;
  time.median = read_number(part.at("median"));
  time.n = part.at("rounds").get<int>();
  if (time.n < 1) throw std::invalid_argument("there are no rounds");
  const json& interval = part.at("interval");
  time.ci95 = interval.is_null() ? Interval{time.median, time.median}
                                 : Interval{read_number(interval.at(0)), read_number(interval.at(1))};
  time.q1 = time.ci95.low;
  time.q3 = time.ci95.high;
  return time;
}

TimedPart read_part(const json& part) {
  TimedPart timed{read_time(part), {}};
  if (part.contains("queries")) timed.queries = read_time(part["queries"]);
  return timed;
}

TimedParts read_parts(const json& cell) {
  TimedParts parts{{}, {}, read_part(cell.at("filter"))};
  if (const json& map = cell.at("map"); !map.is_null()) parts.map = read_part(map);
  if (const json& prefilter = cell.at("prefilter"); !prefilter.is_null()) parts.prefilter = read_part(prefilter);
  return parts;
}

json write_time(const OwnTime& time) {
  return {{"median", time.median}, {"interval", {time.ci95.low, time.ci95.high}}, {"rounds", time.n}};
}

json write_part(const TimedPart& part) {
  json written = write_time(part);
  if (part.queries) written["queries"] = write_time(*part.queries);
  return written;
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

bool is_any_timed(const std::vector<CellRecord>& cells, const GpuTimes& times) {
  return std::ranges::any_of(
      cells, [&](const CellRecord& cell) { return times.cells.contains(cell.key); });
}

}  // namespace

GpuTimes read_gpu_times(const fs::path& file) {
  const std::vector<unsigned char> bytes = read_file_bytes(file, kMostBytes);
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  json written;
  try {
    written = parse_json(stream);
  } catch (const std::exception&) {
    refuse(file, "this is no JSON");
  }
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
      times.cells[name] = read_parts(cell);
    }
  } catch (const std::exception&) {
    refuse(file, key.empty() ? "it has no renderer or no cells"
                             : fmt::format("what it has of the cell {} is no time of map, prefilter and filter", key));
  }
  return times;
}

void require_times_of(const std::vector<CellRecord>& cells, const GpuTimes& times) {
  if (!is_any_timed(cells, times))
    refuse(times.file, "it has times of another run: none of its cells is one of this one");
}

void apply_gpu_times(Results& results, const GpuTimes& times) {
  require_times_of(results.cells, times);
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

json gpu_times_json(const GpuTimes& times) {
  json cells = json::object();
  for (const auto& [key, parts] : times.cells)
    cells[key] = {{"map", parts.map ? write_part(*parts.map) : json()},
                  {"prefilter", parts.prefilter ? write_part(*parts.prefilter) : json()},
                  {"filter", write_part(parts.filter)}};
  return {{"schema", kSchema}, {"renderer", times.renderer}, {"isSoftware", times.software}, {"cells", cells}};
}

fs::path gpu_times_path(const fs::path& report, const std::string& renderer) {
  return report / kFolder / (files::make_file_stem(renderer) + ".json");
}

std::vector<GpuTimes> list_gpu_times(const fs::path& report, const std::vector<CellRecord>& cells,
                                     std::vector<std::string>& warnings) {
  std::error_code error;
  std::set<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(report / kFolder, error))
    if (entry.path().extension() == ".json" && !is_temporary(entry.path())) paths.insert(entry.path());
  std::vector<GpuTimes> list;
  for (const fs::path& path : paths) {
    try {
      list.push_back(read_gpu_times(path));
    } catch (const Error& damaged) {
      warnings.push_back(fmt::format("{}; times of that machine are left out", damaged.what()));
    }
  }
  std::erase_if(list, [&](const GpuTimes& times) { return !is_any_timed(cells, times); });
  return list;
}

}  // namespace shadowbench::records
