#include "report/records/csv_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <string_view>

#include "reference/metrics/metric_table.h"
#include "report/records/csv.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

struct Column {
  CsvColumn column;
  std::function<std::string(const RunRecord&, const CellRecord&)> extract;
};

template <class T>
std::string write_field(const T& value) {
  return fmt::format("{}", value);
}
std::string write_field(bool on) { return on ? "on" : "off"; }
std::string write_field(CellStatus status) { return value_json(status).get<std::string>(); }
std::string write_field(const ParamMap& params) { return dump_line(value_json(params)); }
template <class T>
std::string write_field(const std::optional<T>& value) {
  return value ? write_field(*value) : std::string();
}

/// Makes the column of the member of a cell that a chain of members leads to.
template <auto... Chain>
Column column(std::string name, std::string meaning) {
  return {{std::move(name), std::move(meaning)},
          [](const RunRecord&, const CellRecord& cell) { return write_field((cell.*....*Chain)); }};
}

/// The same of a switch that is written as 1 or 0.
template <bool BiasRecord::*Switch>
Column bit_column(std::string name, std::string meaning) {
  return {{std::move(name), std::move(meaning)},
          [](const RunRecord&, const CellRecord& cell) { return std::string(cell.bias.*Switch ? "1" : "0"); }};
}

using C = CellRecord;
using B = BiasRecord;
using Amount = BiasAmountRecord;

std::vector<Column> setting_columns() {
  return {
      column<&C::scene>("scene", "the scene's name"),
      column<&C::view>("view", "the camera's name"),
      column<&C::filter>("filter", "the filter's id"),
      column<&C::params>("params", "the filter's parameters as JSON"),
      column<&C::kernel, &KernelRecord::sigma_texels>("kernel_sigma_texels",
                                                      "the kernel's standard deviation along an axis, texels"),
      column<&C::kernel, &KernelRecord::width_class>(
          "kernel_class", "the class of kernels that are about as wide, with which alone it is compared"),
      column<&C::map_size>("map_size", "shadow map, texels along a side"),
      column<&C::map_format>("map_format", "the shadow map's format"),
      column<&C::fit>("fit", "how the light's frustum is fitted; snapped: to whole texels"),
      column<&C::light>("light", "where the light stands: as the scene says, or azimuth and elevation in degrees"),
      column<&C::bias, &B::constant, &Amount::depth>("bias_constant_depth", "constant bias, depth in [0,1]"),
      column<&C::bias, &B::constant, &Amount::texels>("bias_constant_texels",
                                                      "constant bias, texels; adds to the one before"),
      column<&C::bias, &B::constant, &Amount::world>("bias_constant_world",
                                                     "constant bias, metres; adds to the two before"),
      column<&C::bias, &B::slope, &Amount::depth>("bias_slope_depth", "bias times 1 - n.l, depth in [0,1]"),
      column<&C::bias, &B::slope, &Amount::texels>("bias_slope_texels", "bias times 1 - n.l, texels"),
      column<&C::bias, &B::slope, &Amount::world>("bias_slope_world", "bias times 1 - n.l, metres"),
      column<&C::bias, &B::plane_texels>("bias_plane_texels", "bias by the slope of the receiver's plane, texels"),
      column<&C::bias, &B::plane_kernels>(
          "bias_plane_kernels",
          "the same, in reaches of the filter: to the centre of the farthest texel that it compares"),
      column<&C::bias, &B::normal_offset, &Amount::texels>("bias_normal_offset_texels", "normal offset, texels"),
      column<&C::bias, &B::normal_offset, &Amount::world>("bias_normal_offset_world", "normal offset, metres"),
      bit_column<&B::receiver_plane>("bias_receiver_plane", "1: the receiver plane's gradient is added for every tap"),
      column<&C::bias, &B::polygon_factor>("bias_polygon_factor", "glPolygonOffset in the depth pass, factor"),
      column<&C::bias, &B::polygon_units>("bias_polygon_units", "glPolygonOffset in the depth pass, units"),
      bit_column<&B::front_cull>("bias_front_cull", "1: front faces are left out of the depth map"),
      bit_column<&B::midpoint>("bias_midpoint", "1: the depth map lies half-way between first and second surface"),
      column<&C::range, &RangeRecord::border>("border", "what lookups read outside the map"),
      column<&C::range, &RangeRecord::far_test>("far_test", "on: what is beyond the map's far plane is lit"),
      column<&C::range, &RangeRecord::behind_test>("behind_test",
                                                   "on: what is behind the light of a projective map is lit"),
      column<&C::width>("width", "picture, pixels"),
      column<&C::height>("height", "picture, pixels"),
      column<&C::status>("status", "ok, suspect, timeout, crashed or error"),
      column<&C::message>("message", "why the status is not ok"),
  };
}

/// Makes a column of one number of an optional spread.
template <class Get>
Column spread_column(std::string name, std::string meaning, Get get) {
  return {{std::move(name), std::move(meaning)},
          [get](const RunRecord&, const CellRecord& cell) { return write_field(get(cell)); }};
}

template <class Spread, class Get>
auto get_if(const std::optional<Spread>& spread, Get get) {
  return spread ? std::optional(get(*spread)) : std::nullopt;
}

template <class Time>
void add_time_columns(std::vector<Column>& columns, const std::string& name, const std::string& meaning,
                      std::optional<Time> TimeRecord::*member) {
  const auto add = [&](const std::string& suffix, const std::string& which, auto Quartiles::*part) {
    columns.push_back(spread_column(name + suffix, meaning + which, [member, part](const CellRecord& cell) {
      return get_if(cell.time_ms.*member, [part](const Quartiles& time) { return time.*part; });
    }));
  };
  add("_median_ms", ", milliseconds, median", &Quartiles::median);
  add("_q1_ms", ", milliseconds, first quartile", &Quartiles::q1);
  add("_q3_ms", ", milliseconds, third quartile", &Quartiles::q3);
  add("_n", ", number of measurements", &Quartiles::n);
}

void add_own_time_columns(std::vector<Column>& columns, const std::string& name, const std::string& meaning,
                          std::optional<OwnTime> TimeRecord::*member) {
  add_time_columns(columns, name, meaning, member);
  const auto add = [&](const std::string& suffix, const std::string& which, double Interval::*end) {
    columns.push_back(spread_column(name + suffix, meaning + which, [member, end](const CellRecord& cell) {
      return get_if(cell.time_ms.*member, [end](const OwnTime& time) { return time.ci95.*end; });
    }));
  };
  add("_low_ms", ", milliseconds, lower end of the median's 95 % interval", &Interval::low);
  add("_high_ms", ", milliseconds, upper end of the median's 95 % interval", &Interval::high);
}

void add_ratio_columns(std::vector<Column>& columns, const std::string& name, const std::string& meaning,
                       std::optional<Ratio> RatioRecord::*member) {
  const auto add = [&](const std::string& suffix, const std::string& which, auto get) {
    columns.push_back(spread_column(
        name + suffix, meaning + which,
        [member, get](const CellRecord& cell) { return get_if(cell.ratio_to_none.*member, get); }));
  };
  add(
      "_median", ", median over rounds", [](const Ratio& ratio) { return ratio.median; });
  add(
      "_low", ", lower end of the 95 % interval", [](const Ratio& ratio) { return ratio.ci95.low; });
  add("_high", ", upper end of the 95 % interval", [](const Ratio& ratio) { return ratio.ci95.high; });
}

void add_phase_columns(std::vector<Column>& columns) {
  columns.push_back(column<&C::phases>("phases", "places of the map's grid that errors of visibility are means over"));
  const auto add = [&](const std::string& name, const std::string& which, double Interval::*end) {
    columns.push_back(spread_column(
        name, "rmse, " + which + " end of its 95 % interval over the phases", [end](const CellRecord& cell) {
          return get_if(cell.rmse_ci95, [end](const Interval& interval) { return interval.*end; });
        }));
  };
  add("rmse_low", "lower", &Interval::low);
  add("rmse_high", "upper", &Interval::high);
}

void add_timing_columns(std::vector<Column>& columns) {
  columns.push_back({{"clock", "what the times are times of"},
                     [](const RunRecord& run, const CellRecord& cell) {
                       return cell.machine ? describe_clock(*cell.machine) : describe_clock(run.gl);
                     }});
  columns.push_back({{"machine",
                      "what measured the times: those of two kinds of machine do not compare; empty in cells "
                      "of before"},
                     [](const RunRecord&, const CellRecord& cell) {
                       return cell.machine ? describe_machine_kind(*cell.machine) : std::string();
                     }});
  add_time_columns(columns, "lookup", "filtered lookup of all pixels", &TimeRecord::lookup);
  add_time_columns(columns, "prefilter", "encoding and blurring the map", &TimeRecord::prefilter);
  add_time_columns(columns, "map", "drawing the depth map", &TimeRecord::map);
  add_time_columns(columns, "empty", "lookup that reads nothing of the map", &TimeRecord::empty);
  add_own_time_columns(columns, "filter", "the filter's own: lookup less that", &TimeRecord::filter);
  add_own_time_columns(columns, "moving", "map, prefilter and the filter's own", &TimeRecord::moving);
  columns.push_back(
      column<&C::time_ms, &TimeRecord::stopped>("stopped", "why no more rounds were timed: rounds, precise or budget"));
  add_ratio_columns(columns, "ratio_lookup", "lookup against none", &RatioRecord::lookup);
  add_ratio_columns(columns, "ratio_static", "frame with a cached map against none", &RatioRecord::static_map);
  add_ratio_columns(columns, "ratio_moving", "frame with a new map against none", &RatioRecord::moving);
}

/// "error.rmse" is rmse, "attribution.model.rms" is model_rms; the truth's keep their group: truth_se.
std::string name_column(const metrics::Metric& metric) {
  std::string name(metric.group() == "truth" ? metric.path : metric.name());
  std::ranges::replace(name, '.', '_');
  return name;
}

Column metric_column(const metrics::Metric& metric) {
  const auto extract = [&metric](const RunRecord&, const CellRecord& cell) {
    std::string field;
    metrics::visit_metric(metric, cell, [&](const std::string&, const auto& value) { field = write_field(value); });
    return field;
  };
  return {{name_column(metric), fmt::format("{}, {}", metric.unit, metric.definition)}, extract};
}

/// Adds the metrics of a group; "" is that of the metrics without one.
void add_metric_columns(std::vector<Column>& columns, std::string_view group) {
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.group() == group) columns.push_back(metric_column(metric));
}

std::vector<Column> columns_of(CsvTable table) {
  std::vector<Column> columns = setting_columns();
  if (table == CsvTable::kAccuracy) {
    for (const metrics::Metric& metric : metrics::metric_table())
      if (metric.group() != "cost" && metric.group() != "map_scale") columns.push_back(metric_column(metric));
    add_phase_columns(columns);
  } else {
    add_timing_columns(columns);
    for (const std::string_view group : {"cost", "", "coverage"}) add_metric_columns(columns, group);
  }
  columns.push_back(column<&C::key>("key", "the cell's file is cells/<key>.json"));
  return columns;
}

std::string join_row(const std::vector<std::string>& fields) {
  std::vector<std::string> quoted(fields.size());
  std::ranges::transform(fields, quoted.begin(), quote_csv);
  return fmt::format("{}\r\n", fmt::join(quoted, ","));
}

}  // namespace

std::vector<CsvColumn> list_csv_columns(CsvTable table) {
  std::vector<CsvColumn> names;
  for (const Column& column : columns_of(table)) names.push_back(column.column);
  return names;
}

std::string make_csv(CsvTable table, const RunRecord& run, const std::vector<CellRecord>& cells) {
  const std::vector<Column> columns = columns_of(table);
  std::vector<std::string> fields;
  for (const Column& column : columns) fields.push_back(column.column.name);
  std::string csv = join_row(fields);
  for (const CellRecord& cell : cells) {
    std::ranges::transform(columns, fields.begin(), [&](const Column& column) { return column.extract(run, cell); });
    csv += join_row(fields);
  }
  return csv;
}

}  // namespace shadowbench::records
