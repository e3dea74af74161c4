#include "report/regress/tolerances.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <optional>
#include <type_traits>

#include "base/toml.h"
#include "report/records/record_fields.h"
#include "report/records/records.h"

namespace shadowbench::regress {
namespace {

template <class Visitor>
void visit_ratios(const records::CellRecord& cell, Visitor visit) {
  records::visit_fields(
      cell,
      [&]<class T>(const std::string& path, const T& value, const records::About& = {}) {
        if constexpr (std::is_same_v<T, std::optional<records::Ratio>>) visit(path, value);
      });
}

}  // namespace

const std::vector<metrics::Metric>& list_compared_metrics() {
  static const std::vector<metrics::Metric> kept = [] {
    std::vector<metrics::Metric> all(metrics::metric_table().begin(), metrics::metric_table().end());
    std::erase_if(all, [](const metrics::Metric& m) { return m.baseline == metrics::MetricBaseline::kNotKept; });
    return all;
  }();
  return kept;
}

bool is_error(const metrics::Metric& metric) {
  return metric.baseline == metrics::MetricBaseline::kError || metric.baseline == metrics::MetricBaseline::kRate;
}

const std::vector<std::string>& list_compared_ratios() {
  static const std::vector<std::string> paths = [] {
    std::vector<std::string> all;
    visit_ratios(records::CellRecord(), [&](const std::string& path, const auto&) { all.push_back(path); });
    return all;
  }();
  return paths;
}

ComparedValues read_values(const records::CellRecord& cell) {
  ComparedValues values;
  for (const metrics::Metric& metric : list_compared_metrics()) {
    const std::optional<double> value = metric.read(cell);
    if (value && std::isfinite(*value)) values.numbers[std::string(metric.path)] = *value;
  }
  if (!cell.time_ms.lookup || cell.time_ms.lookup->n < kFewestRounds) return values;
  visit_ratios(cell, [&](const std::string& path, const std::optional<records::Ratio>& ratio) {
    if (ratio) values.ratios[path] = *ratio;
  });
  return values;
}

std::string find_absence(const records::CellRecord& cell, const std::string& path) {
  if (path.starts_with("ratio_to_none.") && cell.time_ms.lookup && cell.time_ms.lookup->n < kFewestRounds) {
    return fmt::format("it was timed over {} rounds, and {} are the fewest that give an interval",
                       cell.time_ms.lookup->n, kFewestRounds);
  }
  return records::explain_absence(cell, path);
}

namespace {

constexpr double kHalfRounding = 0x1p-12;

Tolerance tolerate(metrics::MetricBaseline baseline) {
  switch (baseline) {
    case metrics::MetricBaseline::kNotKept:
    case metrics::MetricBaseline::kKept: return {HUGE_VAL, "the truth itself is tested pixel by pixel"};
    case metrics::MetricBaseline::kScale:
      return {1e-9, "a map of another scale is another map: the widest kernel of a run pads it, see --pad-texels"};
    case metrics::MetricBaseline::kRate:
      return {0.01, "a rate counts over 100 receivers or more: one of them may fall on the other side of its limit"};
    case metrics::MetricBaseline::kError:
      return {
          kHalfRounding,
          "no mean of errors moves by more than the pixels do; what excused pixels and the truth's noise move it by "
          "is allowed on top"};
    case metrics::MetricBaseline::kCount: break;
  }
  return {0.0, "a count: it does not depend on rounding"};
}

Tolerance read_tolerance(const TomlTable& table) {
  table.require_known_keys({"limit", "reason"});
  const auto limit = table.find("limit"), reason = table.find("reason");
  const double number = limit ? limit->as<double>().value_or(-1.0) : -1.0;
  if (!(number >= 0.0))
    throw table.error(
        fmt::format("the tolerance of {} needs a limit of 0 or more; 'inf' compares it with nothing", table.key()));
  const std::string text = reason ? reason->as<std::string>().value_or("") : "";
  if (text.empty())
    throw table.error(fmt::format("the tolerance of {} needs a reason: what limits the filter there", table.key()));
  return {number, text};
}

void read_filter(Tolerances& tolerances, const std::string& filter, const TomlTable& table) {
  table.require_known_keys(list_limited_metrics());
  for (const TomlValue& each : table.entries())
    tolerances.set(filter, each.key(), read_tolerance(*table.table(each.key())));
}

std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

Tolerances::Tolerances() {
  auto& all = by_filter_[""];
  all[kPixel] = {kHalfRounding, "images are stored as 16-bit floats, which round visibility by up to 2^-12"};
  all[kShare] = {0.0, "what rounding can move is excused pixel by pixel, by name"};
  all[kLargest] = {
      0.0625, "twice the widest tolerance of a pixel that is not excused: 1/32 in the baseline and 1/32 in the run"};
  all[kMean] = {kHalfRounding, "the mean of roundings to 16 bits is at most the largest"};
  all[kExcused] = {0.01, "ties and texel borders wander with the last bit of a depth, and are as many after it"};
  all[kExcusedChanged] = {0.001,
                          "of the pixels that a last bit decides few are decided otherwise elsewhere, and none on any "
                          "llvmpipe that was measured"};
  all[kLevel] = {0.01, "one comparison in a hundred of the same thing may fail by chance"};
  for (const metrics::Metric& metric : list_compared_metrics())
    all[std::string(metric.path)] = tolerate(metric.baseline);
  for (const std::string& path : list_compared_ratios()) {
    all[path] = {
        0.25,
        "ratios of one machine drift; the interval of the run must lie above that of the baseline by this share of it"};
  }
}

const Tolerance& Tolerances::find(const std::string& filter, const std::string& metric) const {
  if (const auto own = by_filter_.find(filter); own != by_filter_.end()) {
    if (const auto found = own->second.find(metric); found != own->second.end()) return found->second;
  }
  const auto found = by_filter_.at("").find(metric);
  assert(found != by_filter_.at("").end());
  return found->second;
}

void Tolerances::set(const std::string& filter, const std::string& metric, Tolerance tolerance) {
  by_filter_[filter][metric] = std::move(tolerance);
}

const std::vector<std::string>& list_limited_metrics() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {kPixel, kShare, kLargest, kMean, kExcused, kExcusedChanged, kLevel};
    for (const metrics::Metric& metric : list_compared_metrics()) all.emplace_back(metric.path);
    for (const std::string& path : list_compared_ratios()) all.push_back(path);
    return all;
  }();
  return names;
}

Tolerances read_tolerances(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    fail_input("this is a folder, and should be the file of the tolerances; remove it", file.string());
  const TomlTable root = read_toml(file, "the tolerances");
  root.require_known_keys({"all", "filter"});
  Tolerances tolerances;
  if (const auto all = root.table("all")) read_filter(tolerances, "", *all);
  if (const auto filters = root.table("filter"))
    for (const TomlValue& each : filters->entries()) read_filter(tolerances, each.key(), *filters->table(each.key()));
  return tolerances;
}

std::string write_tolerances(const Tolerances& tolerances) {
  std::string text =
      "# How far a run may be from this baseline. 'all' holds for every filter, [filter.ID.\"METRIC\"] for one; each "
      "with its reason.\n"
      "# Pixels whose comparison may flip, or whose rounding bound is 1/32 or more, are counted and excused by name "
      "instead.\n";
  for (const auto& [filter, metrics] : tolerances.by_filter_) {
    for (const std::string& name : list_limited_metrics()) {
      const auto found = metrics.find(name);
      if (found == metrics.end()) continue;
      const std::string table = filter.empty() ? "all" : "filter." + quote(filter);
      const std::string limit = std::isinf(found->second.limit) ? "inf" : fmt::format("{}", found->second.limit);
      text +=
          fmt::format("\n[{}.{}]\nlimit = {}\nreason = {}\n", table, quote(name), limit, quote(found->second.reason));
    }
  }
  return text;
}

}  // namespace shadowbench::regress
