#include "report/analysis/width_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

using Configurations = std::vector<TradeConfiguration>;

// The parameters of a filter that say no more than its width: each of their values has one width and each width one
// value.
std::set<std::string> find_width_params(const Configurations& configurations, const std::vector<std::size_t>& chosen,
                                        const std::string& filter) {
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

std::vector<WidthSeries> list_width_series(const Configurations& configurations,
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

}  // namespace shadowbench::analysis
