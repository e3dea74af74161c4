#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/analysis/maps/map_family.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

std::string name_map(const MapUse& map) { return fmt::format("{}, {}", map.fit, map.size); }

// "0.4, less": a ratio, and whether the two can be told apart.
std::string format_ratio(double ratio, int sign) {
  static constexpr const char* kSigns[] = {"less", "not apart", "more"};
  return fmt::format("{}, {}", records::format_number(ratio), kSigns[sign + 1]);
}

std::string describe_sharing(const MapFamily& family, const Sharing& found) {
  if (!found.own) return "no own map is as accurate";
  return fmt::format("{}, against {}",
                     found.from_views
                         ? fmt::format("from {} view{} on", *found.from_views, *found.from_views == 1 ? "" : "s")
                         : "for no number of views",
                     name_map(family.maps[*found.own]));
}

std::string describe_caching(const MapFamily& family, const Caching& found) {
  if (!found.cached) return "no kept map is as accurate";
  return fmt::format("{}, {}", found.pays ? records::format_number(found.saved_ms) : "nothing that can be told",
                     name_map(family.maps[*found.cached]));
}

// A row for each map of a family; columns as in make_map_table().
std::vector<std::vector<std::string>> make_rows(const MapFamily& family) {
  std::vector<std::vector<std::string>> rows;
  for (const MapUse& map : family.maps)
    rows.push_back({family.name, family.place, name_map(map), fmt::format("{}", map.layers),
                    records::format_bytes(static_cast<double>(map.bytes)), records::format_number(map.rmse.value),
                    records::format_number(map.redraw.value), records::format_number(map.lookup.value),
                    records::kNothing, records::kNothing, records::kNothing, records::kNothing,
                    records::format_number(family.drift)});
  for (const LayerComparison& each : compare_layers(family)) {
    rows[each.single][8] = format_ratio(each.error, each.error_sign);
    rows[each.single][9] = format_ratio(each.cost, each.cost_sign);
  }
  for (const Sharing& each : find_sharing(family)) rows[each.shared][10] = describe_sharing(family, each);
  for (const Caching& each : find_caching(family)) rows[each.own][11] = describe_caching(family, each);
  return rows;
}

}  // namespace

records::TextTable make_map_table(const std::vector<MapFamily>& families, const records::GlRecord& gl) {
  const std::string unit = records::time_unit(gl);
  records::TextTable table;
  table.header = {"filter",
                  "where",
                  "map",
                  "layers",
                  "bytes",
                  "RMSE",
                  "map and prefilter, " + unit,
                  "lookup, " + unit,
                  "RMSE of layers of as many bytes over its own",
                  "their cost over its own",
                  "cheaper for all views than a map for each",
                  "a kept map as accurate saves of its frame, " + unit,
                  "drift"};
  for (const MapFamily& family : families)
    for (auto& row : make_rows(family)) table.rows.push_back(std::move(row));
  return table;
}

std::string summarize_maps(const std::vector<MapFamily>& families, const records::GlRecord& gl) {
  std::size_t layered = 0, less_error = 0, less_cost = 0, shared = 0, cheaper = 0;
  std::optional<int> views;
  double saved = 0.0;
  for (const MapFamily& family : families) {
    for (const LayerComparison& each : compare_layers(family)) {
      ++layered;
      less_error += each.error_sign < 0;
      less_cost += each.cost_sign < 0;
    }
    for (const Sharing& each : find_sharing(family)) {
      ++shared;
      cheaper += each.from_views.has_value();
      if (each.from_views) views = std::min(views.value_or(*each.from_views), *each.from_views);
    }
    for (const Caching& each : find_caching(family))
      if (each.pays) saved = std::max(saved, each.saved_ms);
  }
  std::vector<std::string> parts;
  if (layered > 0)
    parts.push_back(
        fmt::format("layers have less error than one map of as many bytes in {} of {} comparisons, and "
                    "less cost in {}",
                    less_error, layered, less_cost));
  if (shared > 0)
    parts.push_back(fmt::format("one map for all views is cheaper than a map for each in {} of {} comparisons{}",
                                cheaper, shared,
                                views ? fmt::format(", from view {} on at the earliest", *views) : ""));
  if (saved > 0.0)
    parts.push_back(
        fmt::format("a kept map saves up to {} {} of a frame", records::format_number(saved), records::time_unit(gl)));
  return parts.empty() ? "" : fmt::format("Of maps of several fits, {}.", fmt::join(parts, "; "));
}

}  // namespace shadowbench::analysis
