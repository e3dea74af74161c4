#include "report/analysis/trade_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/analysis/summary.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

Estimate exact(double value) { return {value, value, value}; }

template <class T>
Measured make_exact(const records::CellRecord& cell, const std::optional<T>& value, const char* group,
                    const char* path) {
  if (value && std::isfinite(static_cast<double>(*value))) return {exact(static_cast<double>(*value)), {}};
  if (cell.status != records::CellStatus::kOk) return {std::nullopt, "the cell did not finish"};
  for (const char* name : {path, group}) {
    const auto reason = cell.absent.find(name);
    if (reason != cell.absent.end()) return {std::nullopt, fmt::format("{}: {}", path, reason->second)};
  }
  return {std::nullopt, fmt::format("{}: not measured", path)};
}

std::optional<double> total_ms(const records::CellRecord& cell, double records::Quartiles::*which, bool moving) {
  const records::TimeRecord& time = cell.time_ms;
  if (!time.lookup || (moving && !time.map)) return std::nullopt;
  double sum = *time.lookup.*which;
  if (moving) sum += *time.map.*which + (time.prefilter ? *time.prefilter.*which : 0.0);
  return sum;
}

Measured read_time(const records::CellRecord& cell, const records::CellRecord* reference, bool moving) {
  const std::optional<records::Ratio>& ratio = moving ? cell.ratio_to_none.moving : cell.ratio_to_none.lookup;
  const auto unit_ms = reference ? total_ms(*reference, &records::Quartiles::median, moving) : std::nullopt;
  if (ratio && unit_ms)
    return {Estimate{ratio->median * *unit_ms, ratio->ci95.low * *unit_ms, ratio->ci95.high * *unit_ms}, {}};
  const auto median = total_ms(cell, &records::Quartiles::median, moving);
  if (!median) return make_exact(cell, std::optional<double>(), "time_ms", moving ? "time_ms.map" : "time_ms.lookup");
  return {Estimate{*median, *total_ms(cell, &records::Quartiles::q1, moving),
                   *total_ms(cell, &records::Quartiles::q3, moving)},
          {}};
}

double mean_of(const std::vector<Estimate>& estimates) {
  double sum = 0.0;
  for (const Estimate& each : estimates) sum += each.value;
  return sum / static_cast<double>(estimates.size());
}

double worst_of(const std::vector<Estimate>& estimates) {
  const auto less = [](const Estimate& a, const Estimate& b) { return a.value < b.value; };
  return std::max_element(estimates.begin(), estimates.end(), less)->value;
}

// Each scene's standard error moves the result by its own share; scenes' truths are independent.
Estimate root_mean_square(const std::vector<Estimate>& estimates) {
  double squares = 0.0, variance = 0.0;
  for (const Estimate& each : estimates) {
    const double se = each.high - each.value;
    squares += each.value * each.value;
    variance += each.value * each.value * se * se;
  }
  const double count = static_cast<double>(estimates.size());
  const double rms = std::sqrt(squares / count);
  const double se = rms > 0.0 ? std::sqrt(variance) / (count * rms) : 0.0;
  return {rms, std::max(0.0, rms - se), rms + se};
}

// The distances of the intervals' ends add up in quadrature, as logarithms of independent measurements do.
Estimate geometric_mean(const std::vector<Estimate>& estimates) {
  double sum = 0.0, below = 0.0, above = 0.0;
  for (const Estimate& each : estimates) {
    if (!(each.low > 0.0)) return exact(mean_of(estimates));
    const double middle = std::log(each.value);
    sum += middle;
    below += std::pow(middle - std::log(each.low), 2);
    above += std::pow(std::log(each.high) - middle, 2);
  }
  const double count = static_cast<double>(estimates.size());
  const double middle = sum / count;
  return {std::exp(middle), std::exp(middle - std::sqrt(below) / count), std::exp(middle + std::sqrt(above) / count)};
}

std::string format_bytes(double bytes) {
  const char* const units[] = {"B", "KiB", "MiB", "GiB"};
  std::size_t unit = 0;
  for (; bytes >= 1024.0 && unit + 1 < std::size(units); ++unit) bytes /= 1024.0;
  return fmt::format("{} {}", records::format_number(bytes), units[unit]);
}

}  // namespace

const std::array<Measure, kErrorMeasures>& list_error_measures() {
  static const std::array<Measure, kErrorMeasures> kMeasures = {
      {{"rmse", "RMSE to the area truth", "root mean square error of visibility; interval: the truth's standard error",
        "root mean square over the scenes", false, false},
       {"kernel_rmse", "RMSE to the filter's exact kernel",
        "root mean square error of visibility against the traced kernel; no interval",
        "root mean square over the scenes", false, false},
       {"leak", "leak rate", "share of the wholly blocked receivers that are bright; no interval", "the worst scene",
        false, false},
       {"flip", "FLIP of the picture", "mean LDR-FLIP of the shaded picture; no interval", "mean over the scenes",
        false, false}}};
  return kMeasures;
}

const std::array<Measure, kCostMeasures>& list_cost_measures() {
  static const char* const kTime = "geometric mean over the scenes";
  static const std::array<Measure, kCostMeasures> kMeasures = {
      {{"lookup", "time of the lookup",
        "what is paid while light and casters stand still: the ratio to the lookup without filter, per round, times "
        "that lookup's median; interval: 95 % of the ratio",
        kTime, true, false},
       {"moving", "time of map, prefilter and lookup",
        "what is paid while they move: the ratio to the same without filter, per round, times its median; interval: 95 "
        "% of the ratio",
        kTime, true, false},
       {"fetches", "texture fetches per receiver", "mean over the receivers, counted in the shader; no interval",
        "mean over the scenes", false, false},
       {"bytes", "bytes of the map", "what the lookup reads, mip levels included; exact", "the largest of the scenes",
        false, true}}};
  return kMeasures;
}

std::string name_axis(const Measure& measure, const records::GlRecord& gl) {
  return measure.is_time ? fmt::format("{}, ms: {}", measure.name, records::describe_clock(gl)) : measure.name;
}

std::string format_value(const Measure& measure, double value) {
  return measure.is_bytes ? format_bytes(value) : records::format_number(value);
}

std::string format_estimate(const Measure& measure, const Estimate& estimate) {
  const std::string value = format_value(measure, estimate.value);
  if (estimate.low == estimate.high) return value;
  return fmt::format("{} [{}, {}]", value, format_value(measure, estimate.low), format_value(measure, estimate.high));
}

Measured read_error(const records::CellRecord& cell, std::size_t measure) {
  switch (measure) {
    case 0: {
      Measured rmse = make_exact(cell, cell.error.rmse, "error", "error.rmse");
      const double se = cell.truth.se.value_or(0.0);
      if (rmse.estimate)
        rmse.estimate = Estimate{*cell.error.rmse, std::max(0.0, *cell.error.rmse - se), *cell.error.rmse + se};
      return rmse;
    }
    case 1: return make_exact(cell, cell.error.kernel_rmse, "error", "error.kernel_rmse");
    case 2: return make_exact(cell, cell.artefact.leak, "artefact", "artefact.leak");
    default: return make_exact(cell, cell.error.flip, "error", "error.flip");
  }
}

Measured read_cost(const records::CellRecord& cell, const records::CellRecord* reference, std::size_t measure) {
  switch (measure) {
    case 0: return read_time(cell, reference, false);
    case 1: return read_time(cell, reference, true);
    case 2: return make_exact(cell, cell.cost.fetches, "cost", "cost.fetches");
    default: return make_exact(cell, cell.cost.map_bytes, "cost", "cost.map_bytes");
  }
}

bool is_reference(const records::CellRecord& cell) {
  const auto& ratio = cell.ratio_to_none.lookup;
  return ratio && ratio->median == 1.0 && ratio->ci95.low == 1.0 && ratio->ci95.high == 1.0;
}

Estimate combine_errors(const std::vector<Estimate>& errors, std::size_t measure) {
  if (measure < 2) return root_mean_square(errors);
  return exact(measure == 2 ? worst_of(errors) : mean_of(errors));
}

Estimate combine_costs(const std::vector<Estimate>& costs, std::size_t measure) {
  if (measure < 2) return geometric_mean(costs);
  return exact(measure == 2 ? mean_of(costs) : worst_of(costs));
}

}  // namespace shadowbench::analysis
