#include "report/analysis/trade.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "filters/kernel.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/configuration.h"
#include "report/analysis/place_state.h"
#include "report/files/file_name.h"
#include "report/records/cell_key.h"
#include "report/records/cell_names.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

constexpr std::size_t kFewestCells = 3;

std::string settings_without(const records::CellRecord& cell, std::initializer_list<const char*> names) {
  auto settings = records::cell_settings(cell);
  for (const char* name : names) settings.erase(name);
  return records::dump_line(settings);
}

std::string place_key(const records::CellRecord& cell) {
  return settings_without(cell, {"filter", "params", "map_size"});
}

std::string picture_key(const records::CellRecord& cell) {
  return settings_without(cell, {"filter", "params", "map_size", "scene", "view"});
}

std::string configuration_key(const records::CellRecord& cell) {
  return records::dump_line(
      nlohmann::json{cell.filter, records::value_json(records::named_params(cell)), cell.map_size});
}

// Groups indices of cells by a key, in the order in which each key first appears.
template <class Key>
std::vector<std::vector<std::size_t>> group_indices(const std::vector<records::CellRecord>& cells,
                                                    const std::vector<std::size_t>& indices, Key key) {
  std::vector<std::vector<std::size_t>> groups;
  std::map<std::string, std::size_t> places;
  for (const std::size_t i : indices) {
    const auto [place, is_new] = places.emplace(key(cells[i]), groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].push_back(i);
  }
  return groups;
}

// Reads cells' errors and costs; those of several scenes are combined.
class CellReader {
 public:
  explicit CellReader(const std::vector<records::CellRecord>& cells)
      : cells_(cells), costs_(list_cost_measures(cells)) {}

  const std::vector<Measure>& costs() const { return costs_; }

  TradeConfiguration read(const std::vector<std::size_t>& indices) const {
    const records::CellRecord& first = cells_[indices.front()];
    const bool is_as_wide = std::ranges::all_of(
        indices, [&](std::size_t i) { return cells_[i].kernel.sigma_texels == first.kernel.sigma_texels; });
    TradeConfiguration result{
        first.filter, records::named_params(first), first.map_size, {}, find_class(first), {}, indices, {}, {}};
    if (is_as_wide) result.sigma_texels = first.kernel.sigma_texels;
    for (std::size_t i = 0; i < kErrorMeasures; ++i)
      result.errors[i] = combine(indices, read_error, list_error_measures()[i]);
    for (const Measure& cost : costs_) result.costs.push_back(combine(indices, read_cost, cost));
    return result;
  }

 private:
  const std::vector<records::CellRecord>& cells_;
  std::vector<Measure> costs_;

  Measured combine(const std::vector<std::size_t>& indices,
                   Measured (*read_one)(const records::CellRecord&, const Measure&), const Measure& measure) const {
    std::vector<Estimate> estimates;
    for (const std::size_t i : indices) {
      const bool is_suspect = cells_[i].status == records::CellStatus::kSuspect;
      Measured one = is_suspect ? Measured{std::nullopt, "suspect: see the warnings"} : read_one(cells_[i], measure);
      if (!one.estimate || indices.size() == 1) return one;
      estimates.push_back(*one.estimate);
    }
    return {measure.combine(estimates), {}};
  }
};

TradeScope make_place_scope(const std::vector<records::CellRecord>& cells, const std::vector<std::size_t>& indices,
                            const CellReader& reader) {
  const records::CellRecord& first = cells[indices.front()];
  TradeScope scope;
  scope.scene = first.scene;
  scope.view = first.view;
  scope.title = fmt::format("{} · view {} · {} × {}", first.scene, first.view, first.width, first.height);
  scope.id = files::make_file_stem(fmt::format("{}.{}.{}x{}", first.scene, first.view, first.width, first.height));
  for (const auto& group : group_indices(cells, indices, configuration_key))
    scope.configurations.push_back(reader.read({group.front()}));
  return scope;
}

TradeScope make_joint_scope(const std::vector<records::CellRecord>& cells, const std::vector<std::size_t>& indices,
                            const CellReader& reader) {
  const records::CellRecord& first = cells[indices.front()];
  const std::size_t places = group_indices(cells, indices, place_key).size();
  const std::size_t scenes =
      group_indices(cells, indices, [](const records::CellRecord& cell) { return cell.scene; }).size();
  TradeScope scope;
  scope.title = fmt::format("{} · {} × {}",
                            places == scenes ? fmt::format("all {} scenes", scenes)
                                             : fmt::format("all {} views of {} scenes", places, scenes),
                            first.width, first.height);
  scope.id = fmt::format("all.{}x{}", first.width, first.height);
  for (const auto& group : group_indices(cells, indices, configuration_key))
    if (group.size() == places)
      scope.configurations.push_back(reader.read(group));
    else
      ++scope.incomplete;
  return scope;
}

// Scopes that differ in another setting than those that their names have are numbered.
void make_unique(std::vector<TradeScope>& scopes) {
  std::map<std::string, int> ids, titles;
  for (TradeScope& scope : scopes) {
    if (const int number = ++ids[scope.id]; number > 1) scope.id += fmt::format(".{}", number);
    if (const int number = ++titles[scope.title]; number > 1)
      scope.title += fmt::format(" · other settings ({})", number);
  }
}

// The parameters of a filter that say no more than its width: each of their values has one width and each width one
// value.
std::set<std::string> find_width_params(const std::vector<TradeConfiguration>& configurations,
                                        const std::vector<std::size_t>& chosen, const std::string& filter) {
  std::map<std::string, std::set<std::pair<double, std::string>>> pairs;
  std::map<std::string, std::set<std::string>> values;
  std::set<double> widths;
  for (const std::size_t i : chosen) {
    if (configurations[i].filter != filter || !configurations[i].sigma_texels) continue;
    widths.insert(*configurations[i].sigma_texels);
    for (const auto& [name, value] : configurations[i].params) {
      const std::string text = records::describe_params({{name, value}});
      pairs[name].insert({*configurations[i].sigma_texels, text});
      values[name].insert(text);
    }
  }
  std::set<std::string> names;
  for (const auto& [name, found] : pairs)
    if (found.size() == widths.size() && values[name].size() == widths.size() && widths.size() > 1) names.insert(name);
  return names;
}

// A series' parameters are named where its filter has several.
void label_series(std::vector<WidthSeries>& all) {
  std::map<std::string, int> counts;
  for (const WidthSeries& series : all) ++counts[series.filter];
  for (WidthSeries& series : all) {
    const bool told = counts[series.filter] > 1 && !series.label.empty();
    series.label = told ? fmt::format("{} ({})", series.filter, series.label) : series.filter;
  }
}

}  // namespace

void label_configurations(std::vector<TradeConfiguration>& configurations,
                          const std::vector<records::CellRecord>& cells) {
  std::vector<const records::CellRecord*> firsts;
  for (const TradeConfiguration& each : configurations) firsts.push_back(&cells[each.cells.front()]);
  const records::CellNames names(firsts);
  for (TradeConfiguration& each : configurations) each.label = names.name(cells[each.cells.front()]);
}

std::vector<TradeScope> make_trade_scopes(const std::vector<records::CellRecord>& cells) {
  std::vector<std::size_t> all(cells.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const CellReader reader(cells);
  std::vector<TradeScope> scopes;
  const std::vector<LeftOutPlace> left_out = list_left_out(point_to(cells));
  std::vector<std::size_t> counted = all;
  std::erase_if(counted, [&](std::size_t i) { return is_left_out(cells[i], left_out); });
  for (const auto& picture : group_indices(cells, counted, picture_key))
    if (group_indices(cells, picture, place_key).size() > 1) scopes.push_back(make_joint_scope(cells, picture, reader));
  for (const auto& place : group_indices(cells, all, place_key))
    scopes.push_back(make_place_scope(cells, place, reader));
  std::set<std::string> fits;
  for (const records::CellRecord& cell : cells) fits.insert(cell.fit);
  for (TradeScope& scope : scopes) {
    const records::CellRecord* first =
        scope.configurations.empty() ? nullptr : &cells[scope.configurations[0].cells[0]];
    scope.width = first ? first->width : 0;
    scope.height = first ? first->height : 0;
    scope.costs = reader.costs();
    if (first && fits.size() > 1) scope.title += " · " + records::name_fit(first->fit, fits);
    label_configurations(scope.configurations, cells);
  }
  std::erase_if(scopes, [](const TradeScope& scope) { return scope.configurations.empty(); });
  make_unique(scopes);
  return scopes;
}

std::vector<WidthSeries> list_width_series(const std::vector<TradeConfiguration>& configurations,
                                           const std::vector<std::size_t>& chosen) {
  std::vector<WidthSeries> all;
  std::map<std::string, std::size_t> places;
  std::map<std::string, std::set<std::string>> names;
  for (const std::size_t i : chosen) {
    const TradeConfiguration& each = configurations[i];
    if (!each.sigma_texels) continue;
    if (!names.contains(each.filter)) names[each.filter] = find_width_params(configurations, chosen, each.filter);
    records::ParamMap params = each.params;
    std::erase_if(params, [&](const auto& param) { return names[each.filter].contains(param.first); });
    const std::string key =
        fmt::format("{} {} {}", each.filter, each.map_size, records::dump_line(records::value_json(params)));
    const auto [place, is_new] = places.emplace(key, all.size());
    if (is_new) all.push_back({each.filter, records::describe_params(params), {}});
    all[place->second].configurations.push_back(i);
  }
  for (WidthSeries& series : all)
    std::ranges::stable_sort(series.configurations, {}, [&](std::size_t i) { return *configurations[i].sigma_texels; });
  label_series(all);
  return all;
}

TradeFront make_trade_front(const TradeScope& scope, std::size_t error, std::size_t cost) {
  TradeFront front;
  front.error = error;
  front.cost = cost;
  for (std::size_t i = 0; i < scope.configurations.size(); ++i) {
    const Measured& e = scope.configurations[i].errors[error];
    const Measured& c = scope.configurations[i].costs[cost];
    if (!e.estimate || !c.estimate) {
      ++front.left_out[e.estimate ? c.absent : e.absent];
      continue;
    }
    front.configurations.push_back(i);
    front.points.push_back({*e.estimate, *c.estimate, scope.configurations[i].width_class});
  }
  front.placements = find_front(front.points);
  front.members = list_members(front.points, front.placements);
  return front;
}

bool has_trade(const std::vector<TradeScope>& scopes) {
  const auto has_one = [](const auto& measured) {
    return std::any_of(
        measured.begin(), measured.end(), [](const Measured& each) { return each.estimate.has_value(); });
  };
  return std::any_of(scopes.begin(), scopes.end(), [&](const TradeScope& scope) {
    const auto count =
        std::count_if(scope.configurations.begin(), scope.configurations.end(),
                      [&](const TradeConfiguration& each) { return has_one(each.errors) && has_one(each.costs); });
    return static_cast<std::size_t>(count) >= kFewestCells;
  });
}

std::vector<std::string> list_filters(const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> filters;
  for (const records::CellRecord& cell : cells)
    if (std::find(filters.begin(), filters.end(), cell.filter) == filters.end()) filters.push_back(cell.filter);
  return filters;
}

}  // namespace shadowbench::analysis
