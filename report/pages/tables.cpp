#include "report/pages/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "reference/metrics/artefacts.h"
#include "report/records/csv.h"
#include "report/records/error_parts.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::pages {
namespace {

using Extract = std::function<std::string(const records::RunRecord&, const records::CellRecord&)>;

struct Column {
  CsvColumn column;
  Extract extract;
};

std::string plain(double value) { return fmt::format("{}", value); }

template <class T>
std::string plain(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

// Columns that depend on the cell alone.
template <class Get>
Column cell_column(std::string name, std::string meaning, Get get) {
  return {{std::move(name), std::move(meaning)},
          [get](const records::RunRecord&, const records::CellRecord& cell) -> std::string { return get(cell); }};
}

std::string name_switch(bool on) { return on ? "on" : "off"; }

std::vector<Column> setting_columns() {
  return {
      cell_column(
          "scene", "the scene's name", [](const records::CellRecord& c) { return c.scene; }),
      cell_column(
          "view", "the camera's name", [](const records::CellRecord& c) { return c.view; }),
      cell_column(
          "filter", "the filter's id", [](const records::CellRecord& c) { return c.filter; }),
      cell_column(
          "params", "the filter's parameters as JSON",
          [](const records::CellRecord& c) { return records::dump_line(records::value_json(c.params)); }),
      cell_column(
          "map_size", "shadow map, texels along a side",
          [](const records::CellRecord& c) { return plain(c.map_size); }),
      cell_column(
          "map_format", "the shadow map's format", [](const records::CellRecord& c) { return c.map_format; }),
      cell_column(
          "fit", "of the light's frustum; snapped: to whole texels",
          [](const records::CellRecord& c) { return c.fit; }),
      cell_column(
          "light", "where the light stands: as the scene says, or azimuth and elevation in degrees",
          [](const records::CellRecord& c) { return c.light; }),
      cell_column(
          "bias_constant_depth", "constant bias, depth in [0,1]",
          [](const records::CellRecord& c) { return plain(c.bias.constant.depth); }),
      cell_column(
          "bias_constant_texels", "constant bias, texels; adds to the one before",
          [](const records::CellRecord& c) { return plain(c.bias.constant.texels); }),
      cell_column(
          "bias_constant_world", "constant bias, metres; adds to the two before",
          [](const records::CellRecord& c) { return plain(c.bias.constant.world); }),
      cell_column(
          "bias_slope_depth", "bias times 1 - n.l, depth in [0,1]",
          [](const records::CellRecord& c) { return plain(c.bias.slope.depth); }),
      cell_column(
          "bias_slope_texels", "bias times 1 - n.l, texels",
          [](const records::CellRecord& c) { return plain(c.bias.slope.texels); }),
      cell_column(
          "bias_slope_world", "bias times 1 - n.l, metres",
          [](const records::CellRecord& c) { return plain(c.bias.slope.world); }),
      cell_column(
          "bias_plane_texels", "bias by the slope of the receiver's plane, texels",
          [](const records::CellRecord& c) { return plain(c.bias.plane_texels); }),
      cell_column(
          "bias_plane_kernels", "the same, in kernel half-widths plus one texel",
          [](const records::CellRecord& c) { return plain(c.bias.plane_kernels); }),
      cell_column(
          "bias_normal_offset_texels", "normal offset, texels",
          [](const records::CellRecord& c) { return plain(c.bias.normal_offset.texels); }),
      cell_column(
          "bias_normal_offset_world", "normal offset, metres",
          [](const records::CellRecord& c) { return plain(c.bias.normal_offset.world); }),
      cell_column(
          "bias_receiver_plane", "1: the receiver plane's gradient is added for every tap",
          [](const records::CellRecord& c) { return plain(c.bias.receiver_plane ? 1.0 : 0.0); }),
      cell_column(
          "bias_polygon_factor", "glPolygonOffset in the depth pass, factor",
          [](const records::CellRecord& c) { return plain(c.bias.polygon_factor); }),
      cell_column(
          "bias_polygon_units", "glPolygonOffset in the depth pass, units",
          [](const records::CellRecord& c) { return plain(c.bias.polygon_units); }),
      cell_column(
          "bias_front_cull", "1: front faces are left out of the depth map",
          [](const records::CellRecord& c) { return plain(c.bias.front_cull ? 1.0 : 0.0); }),
      cell_column(
          "bias_midpoint", "1: the depth map lies half-way between first and second surface",
          [](const records::CellRecord& c) { return plain(c.bias.midpoint ? 1.0 : 0.0); }),
      cell_column(
          "border", "what lookups read outside the map", [](const records::CellRecord& c) { return c.range.border; }),
      cell_column(
          "far_test", "beyond the map's far plane is lit",
          [](const records::CellRecord& c) { return name_switch(c.range.far_test); }),
      cell_column(
          "behind_test", "behind the light of a projective map is lit",
          [](const records::CellRecord& c) { return name_switch(c.range.behind_test); }),
      cell_column(
          "width", "picture, pixels", [](const records::CellRecord& c) { return plain(c.width); }),
      cell_column(
          "height", "picture, pixels", [](const records::CellRecord& c) { return plain(c.height); }),
      cell_column(
          "status", "ok, timeout, crashed or error",
          [](const records::CellRecord& c) { return records::value_json(c.status).get<std::string>(); }),
      cell_column(
          "message", "why the status is not ok", [](const records::CellRecord& c) { return c.message; }),
  };
}

Column clock_column() {
  return {{"clock", "what the times are times of"},
          [](const records::RunRecord& run, const records::CellRecord&) { return records::describe_clock(run.gl); }};
}

Column key_column() {
  return cell_column(
      "key", "the cell's file is cells/<key>.json", [](const records::CellRecord& c) { return c.key; });
}

using TimeMember = std::optional<records::Quartiles> records::TimeRecord::*;

std::vector<Column> time_columns(const std::string& name, const std::string& meaning, TimeMember member) {
  const auto field = [member](auto records::Quartiles::*part) {
    return [member, part](const records::CellRecord& c) {
      const auto& time = c.time_ms.*member;
      return time ? fmt::format("{}", (*time).*part) : std::string();
    };
  };
  return {cell_column(name + "_median_ms", meaning + ", milliseconds, median", field(&records::Quartiles::median)),
          cell_column(name + "_q1_ms", meaning + ", milliseconds, first quartile", field(&records::Quartiles::q1)),
          cell_column(name + "_q3_ms", meaning + ", milliseconds, third quartile", field(&records::Quartiles::q3)),
          cell_column(name + "_n", meaning + ", number of measurements", field(&records::Quartiles::n))};
}

using RatioMember = std::optional<records::Ratio> records::RatioRecord::*;

std::vector<Column> ratio_columns(const std::string& name, const std::string& meaning, RatioMember member) {
  const auto field = [member](auto get) {
    return [member, get](const records::CellRecord& c) {
      const auto& ratio = c.ratio_to_none.*member;
      return ratio ? plain(get(*ratio)) : std::string();
    };
  };
  return {cell_column(name + "_median", meaning + ", median over rounds",
                      field([](const records::Ratio& r) { return r.median; })),
          cell_column(name + "_low", meaning + ", 95 % interval",
                      field([](const records::Ratio& r) { return r.ci95.low; })),
          cell_column(name + "_high", meaning + ", 95 % interval",
                      field([](const records::Ratio& r) { return r.ci95.high; }))};
}

std::vector<Column> cost_columns() {
  return {
      cell_column(
          "fetches", "texture fetches per receiver, mean",
          [](const records::CellRecord& c) { return plain(c.cost.fetches); }),
      cell_column(
          "bytes_per_texel", "of what the lookup reads",
          [](const records::CellRecord& c) { return plain(c.cost.bytes_per_texel); }),
      cell_column(
          "passes", "passes per frame", [](const records::CellRecord& c) { return plain(c.cost.passes); }),
      cell_column(
          "map_bytes", "memory of the maps", [](const records::CellRecord& c) { return plain(c.cost.map_bytes); }),
      cell_column(
          "prefilter_texels", "texels that the prefilter writes",
          [](const records::CellRecord& c) { return plain(c.cost.prefilter_texels); }),
      cell_column(
          "receivers", "pixels that count", [](const records::CellRecord& c) { return plain(c.receivers); }),
      cell_column(
          "nan", "pixels whose visibility is not finite", [](const records::CellRecord& c) { return plain(c.nan); }),
  };
}

std::vector<Column> error_columns() {
  return {
      cell_column(
          "rmse", "root mean square of visibility less area truth",
          [](const records::CellRecord& c) { return plain(c.error.rmse); }),
      cell_column(
          "mae", "mean absolute error", [](const records::CellRecord& c) { return plain(c.error.mae); }),
      cell_column(
          "p95", "95th percentile of the absolute error",
          [](const records::CellRecord& c) { return plain(c.error.p95); }),
      cell_column(
          "max", "largest absolute error", [](const records::CellRecord& c) { return plain(c.error.max); }),
      cell_column(
          "mean", "mean error; positive: too bright", [](const records::CellRecord& c) { return plain(c.error.mean); }),
      cell_column(
          "flip", "mean LDR-FLIP of the picture against the one shaded with the area truth",
          [](const records::CellRecord& c) { return plain(c.error.flip); }),
      cell_column(
          "kernel_rmse",
          "root mean square of visibility less kernel truth: what the filter's own kernel sees, ray traced",
          [](const records::CellRecord& c) { return plain(c.error.kernel_rmse); }),
      cell_column(
          "truth_se", "standard error of the truth, root mean square over the pixels that count",
          [](const records::CellRecord& c) { return plain(c.truth.se); }),
      cell_column(
          "truth_unanimous", "share of those pixels whose rays all agree",
          [](const records::CellRecord& c) { return plain(c.truth.unanimous); }),
      cell_column(
          "receivers", "pixels that count", [](const records::CellRecord& c) { return plain(c.receivers); }),
      cell_column(
          "nan", "pixels whose visibility is not finite", [](const records::CellRecord& c) { return plain(c.nan); }),
  };
}

std::vector<Column> coverage_columns() {
  const auto column = [](const char* name, const char* meaning,
                         std::optional<double> records::CoverageRecord::*member) {
    return cell_column(name, meaning, [member](const records::CellRecord& c) { return plain(c.coverage.*member); });
  };
  return {column("texels_per_pixel", "map texels under a pixel's footprint, median over the pixels that count",
                 &records::CoverageRecord::texels_per_pixel),
          column("fewest_texels_per_pixel", "the same of the pixel with the fewest",
                 &records::CoverageRecord::fewest_texels_per_pixel),
          column("map_used", "share in [0,1] of the map's area under the pixels' footprints",
                 &records::CoverageRecord::map_used),
          column("map_filled", "share in [0,1] of the map's texels that hold a caster",
                 &records::CoverageRecord::map_filled)};
}

std::vector<Column> artefact_columns() {
  const metrics::ArtefactLimits& limits = metrics::kArtefactLimits;
  const auto column = [](const char* name, const std::string& meaning,
                         std::optional<double> records::ArtefactRecord::*member) {
    return cell_column(name, meaning, [member](const records::CellRecord& c) { return plain(c.artefact.*member); });
  };
  return {
      column("acne",
             fmt::format(
                 "share in [0,1] of the wholly lit receivers (before the area light, and in the map within the run's "
                 "widest kernel and {} texel) that are darker than {}",
                 limits.guard_texels, limits.acne_below),
             &records::ArtefactRecord::acne),
      column("leak",
             fmt::format("share in [0,1] of the receivers wholly blocked by something farther than {} texels that are "
                         "brighter than {}",
                         limits.contact_texels, limits.leak_above),
             &records::ArtefactRecord::leak),
      column(
          "contact_gap",
          fmt::format("share in [0,1] of the receivers blocked by a surface within {} texels that are brighter than {}",
                      limits.contact_texels, limits.contact_gap_above),
          &records::ArtefactRecord::contact_gap),
      column("noise",
             fmt::format("share in [0,1] of the receivers in the filter's penumbra where the image less its own "
                         "percentage-closer filter is more than {} off its 3 x 3 mean",
                         limits.noise_above),
             &records::ArtefactRecord::noise),
  };
}

std::vector<Column> attribution_columns() {
  std::vector<Column> columns;
  for (const records::ErrorPart& part : records::list_error_parts()) {
    const auto record = part.record;
    columns.push_back(cell_column(
        fmt::format("{}_rms", part.id),
        fmt::format("root mean square of the error's part {}, visibility: {}", part.name, part.meaning),
        [record](const records::CellRecord& c) { return plain((c.attribution.*record).rms); }));
    columns.push_back(cell_column(
        fmt::format("{}_share", part.id),
        fmt::format("mean(error * part) / mean(error^2) of the part {}; the four sum to 1, and may be negative",
                    part.name),
        [record](const records::CellRecord& c) { return plain((c.attribution.*record).share); }));
  }
  return columns;
}

std::vector<Column> stability_columns() {
  const auto column = [](const char* name, const char* meaning, auto records::StabilityRecord::*member) {
    return cell_column(name, meaning, [member](const records::CellRecord& c) { return plain(c.stability.*member); });
  };
  return {
      column("overflow_texels", "texels of the encoded map that overflowed, or into which the blur mixed one that did",
             &records::StabilityRecord::overflow_texels),
      column("nan_texels", "texels of the encoded map that are NaN", &records::StabilityRecord::nan_texels),
      column("negative_variance_texels", "texels of a map of moments whose variance is below 0 before any clamp",
             &records::StabilityRecord::negative_variance_texels),
      column("lowest_variance", "of a map of moments, before any clamp", &records::StabilityRecord::lowest_variance),
      column("headroom", "ln(largest number of the store) - ln(largest stored value): what exponents could grow by",
             &records::StabilityRecord::headroom),
      column("safe_exponent", "largest value of the filter's exponent with which no texel of this map overflows",
             &records::StabilityRecord::safe_exponent),
      column("half_difference_max", "largest difference of visibility between the 16-bit store and the 32-bit store",
             &records::StabilityRecord::half_difference_max),
      column("half_difference_rms", "the same, root mean square over the pixels that count",
             &records::StabilityRecord::half_difference_rms),
      column("bound_shortfall_max",
             "by how much a bound is darker than the percentage-closer filter of its own kernel and depth",
             &records::StabilityRecord::bound_shortfall_max),
      column("bound_violations", "receivers where it is by more than rounding explains",
             &records::StabilityRecord::bound_violations),
      column("bound_exact_violations",
             "receivers where it is in double precision too: with these parameters it is no bound",
             &records::StabilityRecord::bound_exact_violations)};
}

std::vector<Column> columns_of(CsvTable table) {
  std::vector<Column> columns = setting_columns();
  const auto append = [&](const std::vector<Column>& more) { columns.insert(columns.end(), more.begin(), more.end()); };
  if (table == CsvTable::kAccuracy) {
    append(error_columns());
    append(coverage_columns());
    append(artefact_columns());
    append(attribution_columns());
    append(stability_columns());
    columns.push_back(key_column());
    return columns;
  }
  columns.push_back(clock_column());
  append(time_columns("lookup", "filtered lookup of all pixels", &records::TimeRecord::lookup));
  append(time_columns("prefilter", "encoding and blurring the map", &records::TimeRecord::prefilter));
  append(time_columns("map", "drawing the depth map", &records::TimeRecord::map));
  append({cell_column("stopped", "why no more rounds were timed: rounds, precise or budget",
                      [](const records::CellRecord& c) { return c.time_ms.stopped.value_or(""); })});
  append(ratio_columns("ratio_lookup", "lookup against none", &records::RatioRecord::lookup));
  append(ratio_columns("ratio_static", "frame with a cached map against none", &records::RatioRecord::static_map));
  append(ratio_columns("ratio_moving", "frame with a new map against none", &records::RatioRecord::moving));
  append(cost_columns());
  append(coverage_columns());
  columns.push_back(key_column());
  return columns;
}

std::string join_row(const std::vector<std::string>& fields) {
  std::vector<std::string> quoted(fields.size());
  std::transform(fields.begin(), fields.end(), quoted.begin(), records::quote_csv);
  return fmt::format("{}\r\n", fmt::join(quoted, ","));
}

}  // namespace

std::vector<CsvColumn> list_csv_columns(CsvTable table) {
  std::vector<CsvColumn> names;
  for (const Column& column : columns_of(table)) names.push_back(column.column);
  return names;
}

std::string make_csv(CsvTable table, const records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  const std::vector<Column> columns = columns_of(table);
  std::vector<std::string> fields;
  for (const Column& column : columns) fields.push_back(column.column.name);
  std::string csv = join_row(fields);
  for (const records::CellRecord& cell : cells) {
    std::transform(columns.begin(), columns.end(), fields.begin(),
                   [&](const Column& column) { return column.extract(run, cell); });
    csv += join_row(fields);
  }
  return csv;
}

page::Details explain_columns(const std::string& file, const std::vector<CsvColumn>& columns) {
  page::Facts facts;
  for (const CsvColumn& column : columns) facts.items.push_back({column.name, column.meaning});
  return {"Columns of " + file, {facts}};
}

}  // namespace shadowbench::pages
