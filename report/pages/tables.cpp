#include "report/pages/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reference/metrics/metric_table.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

std::string format_quartiles(const std::optional<records::Quartiles>& time) {
  return time ? fmt::format("{} [{}, {}]", records::format_number(time->median), records::format_number(time->q1),
                            records::format_number(time->q3))
              : records::kNothing;
}

std::string format_own(const std::optional<records::OwnTime>& time) {
  return time ? records::format_interval(time->median, time->ci95) : records::kNothing;
}

constexpr const char* kKernelColumn = "kernel width (class)";

using Metrics = std::vector<const metrics::Metric*>;

/// The metrics of a group that have a column here.
Metrics list_tabled(std::string_view group) {
  Metrics tabled;
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled && metric.group() == group) tabled.push_back(&metric);
  return tabled;
}

// The only metric with an interval.
bool is_rmse(const metrics::Metric& metric) { return metric.path == "error.rmse"; }

void add_titles(std::vector<std::string>& header, const Metrics& tabled) {
  for (const metrics::Metric* metric : tabled)
    header.push_back(std::string(metric->title) + (is_rmse(*metric) ? " [95 % over phases]" : ""));
}

void add_values(std::vector<std::string>& row, const Metrics& tabled, const records::CellRecord& cell) {
  for (const metrics::Metric* metric : tabled) {
    const std::optional<double> value = metric->read(cell);
    row.push_back(value && is_rmse(*metric) && cell.rmse_ci95 ? records::format_interval(*value, *cell.rmse_ci95)
                  : metric->unit == "share"                   ? records::format_rate(value)
                                                              : records::format_number(value));
  }
}

std::string format_dominating_part(const records::CellRecord& cell) {
  if (analysis::is_lost_in_truth(cell)) return "none: within the truth's own error";
  const auto shares = records::list_shares(cell);
  if (!shares) return records::kNothing;
  const auto part = analysis::find_dominating_part(*shares);
  return part ? fmt::format("{} {}", records::list_error_parts()[*part].id, records::format_share(*(*shares)[*part]))
              : "none";
}

// "numeric / estimator / discretisation / model", and the numbers in that order.
std::string join_part_names() {
  std::vector<std::string> names;
  for (const records::ErrorPart& part : records::list_error_parts()) names.emplace_back(part.id);
  return fmt::format("{}", fmt::join(names, " / "));
}

std::string format_shares(const records::CellRecord& cell) {
  const auto shares = records::list_shares(cell);
  if (!shares) return records::kNothing;
  std::vector<std::string> texts;
  for (const auto& share : *shares) texts.push_back(share ? records::format_share(*share) : records::kNothing);
  return fmt::format("{}", fmt::join(texts, " / "));
}

}  // namespace

records::TextTable make_cost_table(const analysis::CellGroup& group, const records::GlRecord& gl) {
  const std::string unit = records::time_unit(gl);
  const Metrics costs = list_tabled("cost");
  records::TextTable table;
  table.header = {"filter",
                  "parameters",
                  kKernelColumn,
                  fmt::format("moving light: map, prefilter, filter, {}, median [95 %]", unit),
                  fmt::format("static light: filter alone, {}, median [95 %]", unit),
                  fmt::format("lookup, {}, median [quartiles]", unit),
                  fmt::format("prefilter, {}", unit),
                  fmt::format("map, {}", unit)};
  const auto has_screen = [](const records::CellRecord& cell) { return cell.time_ms.screen.has_value(); };
  const bool shows_screen = std::ranges::any_of(group.cells, has_screen);
  if (shows_screen) table.header.push_back(fmt::format("of the lookup on the screen, {}", unit));
  add_titles(table.header, costs);
  table.header.emplace_back("status");
  for (const records::CellRecord& cell : group.cells) {
    auto& row = table.rows.emplace_back(std::vector<std::string>{
        cell.filter, cell.params.empty() ? records::kNothing : records::describe_params(cell.params),
        records::describe_kernel(cell.kernel), format_own(cell.time_ms.moving), format_own(cell.time_ms.static_light),
        format_quartiles(cell.time_ms.lookup), format_quartiles(cell.time_ms.prefilter),
        format_quartiles(cell.time_ms.map)});
    if (shows_screen) row.push_back(format_quartiles(cell.time_ms.screen));
    add_values(row, costs, cell);
    row.push_back(records::describe_status(cell));
  }
  return table;
}

records::TextTable make_accuracy_table(const analysis::CellGroup& group) {
  const Metrics errors = list_tabled("error"), artefacts = list_tabled("artefact");
  records::TextTable table;
  table.header = {"filter", kKernelColumn};
  add_titles(table.header, errors);
  table.header.emplace_back("dominating part, first phase");
  add_titles(table.header, artefacts);
  table.header.push_back("share of " + join_part_names() + ", first phase");
  for (const records::CellRecord& cell : group.cells) {
    auto& row = table.rows.emplace_back(
        std::vector<std::string>{group.names.name(cell), records::describe_kernel(cell.kernel)});
    add_values(row, errors, cell);
    row.push_back(format_dominating_part(cell));
    add_values(row, artefacts, cell);
    row.push_back(format_shares(cell));
  }
  return table;
}

void explain_columns(document::Details& details, const std::string& file,
                     const std::vector<records::CsvColumn>& columns) {
  document::Facts facts;
  for (const records::CsvColumn& column : columns) facts.items.push_back({column.name, column.meaning});
  details.blocks.emplace_back(document::Heading{file});
  details.blocks.emplace_back(std::move(facts));
}

namespace {

using Cascades = std::vector<records::CascadeRecord>;

std::string head_cascade(const records::CascadeRecord& cascade) {
  return fmt::format("to {} m", records::format_number(cascade.end_m));
}

std::string say_share(const records::CascadeRecord& cascade) {
  return cascade.share > 0.0 && cascade.share < 0.005 ? "under 1 %" : records::format_share(cascade.share);
}

/// What all filters share: one row for each cascade.
document::Table make_facts(const Cascades& cascades) {
  records::TextTable table;
  table.header = {"cascade", "of the farthest", "texels per metre", "texels per pixel", "receivers"};
  for (const records::CascadeRecord& each : cascades)
    table.rows.push_back({head_cascade(each), fmt::format("{:.4f}", each.end_m / cascades.back().end_m),
                          records::format_number(each.texels_per_m), records::format_number(each.texels_per_pixel),
                          say_share(each)});
  return {"Where each cascade ends along the camera's axis, and what it has to draw", std::move(table)};
}

/// One row for each filter, one column for each cascade, and perhaps one more.
template <class Say>
document::Table make_table(std::string caption, const analysis::CellGroup& group, const Say& say, bool has_seam) {
  document::Table made{std::move(caption), {}};
  made.table.header = {"filter"};
  for (const records::CascadeRecord& each : *group.cells.front().cascades)
    made.table.header.push_back(head_cascade(each));
  if (has_seam) made.table.header.emplace_back("seam");
  for (const records::CellRecord& cell : group.cells) {
    auto& row = made.table.rows.emplace_back(std::vector<std::string>{group.names.name(cell)});
    for (const records::CascadeRecord& each : *cell.cascades) row.push_back(say(each));
    if (has_seam) row.push_back(records::format_number(cell.artefact.seam));
  }
  return made;
}

std::string say_faults(const records::CascadeRecord& cascade) {
  std::vector<std::string> rates;
  for (const auto& rate : {cascade.acne, cascade.leak, cascade.contact_gap})
    rates.push_back(rate ? records::format_share(*rate) : records::kNothing);
  return fmt::format("{}", fmt::join(rates, " / "));
}

}  // namespace

std::optional<document::Section> make_cascade_section(const std::vector<records::CellRecord>& cells) {
  std::vector<records::CellRecord> own;
  std::ranges::copy_if(cells, std::back_inserter(own), [](const auto& cell) { return cell.cascades.has_value(); });
  if (own.empty()) return std::nullopt;
  document::Section section{"cascades", "By cascade", {}};
  for (const analysis::CellGroup& group : analysis::group_cells(own)) {
    const Cascades& cascades = *group.cells.front().cascades;
    std::vector<document::Block> blocks = {
        make_facts(cascades),
        make_table(
            "RMSE over the receivers of each cascade, and the seam between them", group,
            [](const records::CascadeRecord& each) { return records::format_number(each.rmse); }, true),
        make_table("Acne / leak / contact gap in each cascade", group, say_faults, false)};
    const std::string head =
        fmt::format("{}, map {}, {}", group.scene, group.cells.front().map_size, group.cells.front().fit);
    if (section.blocks.empty()) {
      section.blocks.emplace_back(document::Heading{head});
      std::ranges::move(blocks, std::back_inserter(section.blocks));
    } else {
      section.blocks.emplace_back(document::Details{head, std::move(blocks)});
    }
  }
  return section;
}

namespace {

constexpr const char* kNote =
    "Each row is one picture, so that its errors stand beside those of our filters in the first phase of the map's "
    "grid. Without silhouettes: receivers none of whose neighbours lies on another surface. Cost is what its user "
    "says. Nothing is advised of these rows, for what they cost here is not known.";

std::string format_shift(const records::ExternalRecord& external) {
  if (!external.shift_x) return "not known";
  return fmt::format("{:.3f} by {}{}", std::hypot(*external.shift_x, *external.shift_y), external.aligned_by,
                     external.unaligned ? ": NOT our view" : "");
}

/// The run's filters about as good: the best that is worse, and the worst that is better.
std::string describe_peers(const records::CellRecord& cell) {
  if (!cell.error.rmse) return {};
  const std::pair<const std::string, double>*better = nullptr, *worse = nullptr;
  for (const auto& peer : cell.external->peers) {
    if (peer.second <= *cell.error.rmse && (!better || peer.second > better->second)) better = &peer;
    if (peer.second > *cell.error.rmse && (!worse || peer.second < worse->second)) worse = &peer;
  }
  std::vector<std::string> parts;
  if (better) parts.push_back(fmt::format("{} {}", better->first, records::format_number(better->second)));
  if (worse) parts.push_back(fmt::format("{} {}", worse->first, records::format_number(worse->second)));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

std::string describe_engine(const records::ExternalRecord& external) {
  std::vector<std::string> parts;
  const std::string engine = fmt::format("{} {}", external.engine.value_or(""), external.version.value_or(""));
  if (engine != " ") parts.push_back(engine);
  for (const auto& [name, text] : {std::pair("map", &external.map), std::pair("bias", &external.bias),
                                   std::pair("fit", &external.fit), std::pair("driver", &external.driver)})
    if (*text) parts.push_back(fmt::format("{} {}", name, **text));
  return fmt::format("{}", fmt::join(parts, " · "));
}

std::optional<document::Section> make_external_section(const std::vector<records::CellRecord>& cells) {
  records::TextTable table{{"row", "scene", "RMSE", "without silhouettes", "our filters beside it",
                            "nearest, and how far", "acne", "leak", "shift, pixels"},
                           {}};
  records::TextTable origins{{"row", "scene", "drawn by", "undefined receivers", "cost, as its user says"}, {}};
  std::vector<const records::CellRecord*> rows;
  for (const records::CellRecord& cell : cells)
    if (cell.external) rows.push_back(&cell);
  const std::vector<analysis::Place> places = analysis::list_places(rows);
  const auto varies = [&](auto member) {
    return std::ranges::any_of(rows, [&](const auto* row) { return row->*member != rows.front()->*member; });
  };
  for (const records::CellRecord* row : rows) {
    const records::CellRecord& cell = *row;
    const records::ExternalRecord& external = *cell.external;
    std::string place = analysis::describe_place(analysis::place_of(cell), places);
    if (varies(&records::CellRecord::map_size)) place += fmt::format(", beside map {}", cell.map_size);
    if (varies(&records::CellRecord::width)) place += fmt::format(", {} x {}", cell.width, cell.height);
    table.rows.push_back({cell.filter, place, records::format_number(cell.error.rmse),
                          records::format_number(external.inside_rmse), describe_peers(cell),
                          external.nearest
                              ? fmt::format("{}, {}", *external.nearest, records::format_number(external.nearest_rmse))
                              : "–",
                          records::format_number(cell.artefact.acne), records::format_number(cell.artefact.leak),
                          format_shift(external)});
    origins.rows.push_back({cell.filter, place, describe_engine(external), fmt::format("{}", external.undefined),
                            external.ms ? fmt::format("{} ms{}", records::format_number(external.ms),
                                                      external.timed ? ", " + *external.timed : "")
                                        : "–"});
  }
  if (table.rows.empty()) return std::nullopt;
  return document::Section{
      "external",
      "Other renderers",
      {document::Table{"What other renderers drew, against the same truth", std::move(table)},
       document::Details{"What drew them", {document::Table{"As their users say", std::move(origins)}}},
       document::Paragraph{kNote, true}}};
}

}  // namespace shadowbench::pages
