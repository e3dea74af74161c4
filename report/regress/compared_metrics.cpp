#include "report/regress/compared_metrics.h"

#include <fmt/format.h>

#include <cmath>

#include "report/records/record_fields.h"

namespace shadowbench::regress {
namespace {

/// Says what a field's change means; nothing for fields that a baseline does not keep. The largest error of a single
/// pixel, percentiles, which move in steps, and shares of errors, which divide by them, say less than the pixels
/// themselves.
std::optional<MetricRole> role_of(const std::string& path) {
  if (path == "error.max" || path == "error.p95" || path.ends_with(".share")) return std::nullopt;
  for (const char* group : {"error.", "artefact.", "attribution."})
    if (path.starts_with(group)) return MetricRole::kError;
  if (path.starts_with("cost.")) return MetricRole::kCost;
  if (path == "receivers" || path == "nan" || path == "truth.se" || path.starts_with("map_scale."))
    return MetricRole::kCount;
  return std::nullopt;
}

struct MetricLister {
  std::vector<ComparedMetric>& metrics;

  void operator()(const std::string& path, const std::optional<double>&) const { add(path); }
  void operator()(const std::string& path, const std::optional<std::int64_t>&) const { add(path); }
  template <class T>
  void operator()(const std::string&, const T&) const {}

  void add(const std::string& path) const {
    if (const auto role = role_of(path)) metrics.push_back({path, *role});
  }
};

struct ValueReader {
  ComparedValues& values;

  void operator()(const std::string& path, const std::optional<double>& value) const {
    if (value && std::isfinite(*value) && role_of(path)) values.numbers[path] = *value;
  }
  void operator()(const std::string& path, const std::optional<std::int64_t>& value) const {
    if (value && role_of(path)) values.numbers[path] = static_cast<double>(*value);
  }
  void operator()(const std::string& path, const std::optional<records::Ratio>& value) const {
    if (value) values.ratios[path] = *value;
  }
  template <class T>
  void operator()(const std::string&, const T&) const {}
};

struct RatioLister {
  std::vector<std::string>& paths;

  void operator()(const std::string& path, const std::optional<records::Ratio>&) const { paths.push_back(path); }
  template <class T>
  void operator()(const std::string&, const T&) const {}
};

}  // namespace

const std::vector<ComparedMetric>& list_compared_metrics() {
  static const std::vector<ComparedMetric> metrics = [] {
    std::vector<ComparedMetric> all;
    const records::CellRecord cell;
    records::visit_cell_fields(cell, MetricLister{all});
    return all;
  }();
  return metrics;
}

const std::vector<std::string>& list_compared_ratios() {
  static const std::vector<std::string> paths = [] {
    std::vector<std::string> all;
    const records::CellRecord cell;
    records::visit_cell_fields(cell, RatioLister{all});
    return all;
  }();
  return paths;
}

ComparedValues read_values(const records::CellRecord& cell) {
  ComparedValues values;
  records::visit_cell_fields(cell, ValueReader{values});
  if (!cell.time_ms.lookup || cell.time_ms.lookup->n < kFewestRounds) values.ratios.clear();
  return values;
}

std::string find_absence(const records::CellRecord& cell, const std::string& path) {
  if (path.starts_with("ratio_to_none.") && cell.time_ms.lookup && cell.time_ms.lookup->n < kFewestRounds) {
    return fmt::format("it was timed over {} rounds, and {} are the fewest that give an interval",
                       cell.time_ms.lookup->n, kFewestRounds);
  }
  for (std::string name = path;; name.resize(name.rfind('.'))) {
    if (const auto reason = cell.absent.find(name); reason != cell.absent.end()) return reason->second;
    if (name.find('.') == std::string::npos) return "not measured";
  }
}

}  // namespace shadowbench::regress
