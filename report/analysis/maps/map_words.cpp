#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/analysis/maps/map_family.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr double kSteady = 1.25;  // a drift that is not worth a warning

std::string name_head(const MapFamily& family) { return fmt::format("{} on {}", family.name, family.place); }

std::string name_map(const MapUse& map) { return fmt::format("{} map of {}", map.fit, map.size); }

std::string count_views(int views) { return fmt::format("{} view{}", views, views == 1 ? "" : "s"); }

std::string name_winner(const LayerComparison& found) {
  const int error = found.error_sign, cost = found.cost_sign;
  if (error == 0 && cost == 0) return "cannot be told apart";
  if (cost == 0) return fmt::format("{} error, costs cannot be told apart", error < 0 ? "less" : "more");
  if (error == 0) return fmt::format("{} cost, errors cannot be told apart", cost < 0 ? "less" : "more");
  if (error == cost) return error < 0 ? "the layers win both" : "the one map wins both";
  return error < 0 ? "less error costs time" : "less time costs error";
}

// The single maps with their ratios, those of one verdict together.
std::string describe_layers_of(const MapFamily& family, const std::vector<LayerComparison>& found) {
  const MapUse &layered = family.maps[found.front().layered], &first = family.maps[found.front().single];
  std::vector<std::pair<std::string, std::vector<std::string>>> verdicts;
  for (const LayerComparison& each : found) {
    const std::string verdict = name_winner(each);
    auto of = std::ranges::find(verdicts, verdict, &decltype(verdicts)::value_type::first);
    if (of == verdicts.end()) of = verdicts.insert(of, {verdict, {}});
    const bool leads = &each == &found.front();  // says what the two numbers are
    of->second.push_back(fmt::format("{} ({}{}, {}{})", family.maps[each.single].fit, leads ? "RMSE × " : "",
                                     records::format_number(each.error), leads ? "cost × " : "",
                                     records::format_number(each.cost)));
  }
  std::vector<std::string> parts;
  for (const auto& [verdict, maps] : verdicts) parts.push_back(fmt::format("{}: {}", verdict, fmt::join(maps, ", ")));
  return fmt::format("{}, {}: {} layers of {} ({}) against one map of {}; {}.", name_head(family),
                     records::format_bytes(static_cast<double>(layered.bytes)), layered.layers, layered.size,
                     layered.fit, first.size, fmt::join(parts, "; "));
}

std::string describe_sharing_of(const MapFamily& family, const Sharing& found, const std::string& unit) {
  const MapUse& shared = family.maps[found.shared];
  const std::string head =
      fmt::format("a {} for all views costs {} {} and {} for each view", name_map(shared),
                  records::format_number(shared.redraw.value), unit, records::format_number(shared.lookup.value));
  const std::string rmse = records::format_number(shared.rmse.value);
  if (!found.own) return fmt::format("{}; no map of a view's own is as accurate (RMSE {})", head, rmse);
  const MapUse& own = family.maps[*found.own];
  return fmt::format("{}, and the cheapest own map as accurate ({}, RMSE {} against {}) {} for each: sharing is {}",
                     head, name_map(own), records::format_number(own.rmse.value), rmse,
                     records::format_number(own.frame().value),
                     found.from_views ? fmt::format("cheaper from {} on", count_views(*found.from_views))
                                      : "clearly cheaper for no number of views");
}

// "72 to 92 %" of frames is drawing and prefilter.
std::string describe_redrawing(const MapFamily& family) {
  double least = 1.0, most = 0.0;
  for (const MapUse& map : family.maps) {
    if (map.shared || !(map.frame().value > 0.0)) continue;
    least = std::min(least, map.redraw.value / map.frame().value);
    most = std::max(most, map.redraw.value / map.frame().value);
  }
  return fmt::format("{:.0f} to {}", 100.0 * least, records::format_share(most));
}

std::string describe_caching_of(const MapFamily& family, const std::vector<Caching>& found, const std::string& unit) {
  std::vector<std::string> parts;
  std::vector<double> errors, shared_errors;
  for (const MapUse& map : family.maps)
    if (map.shared) shared_errors.push_back(map.rmse.value);
  for (const Caching& each : found) {
    const MapUse& own = family.maps[each.own];
    if (!each.cached)
      errors.push_back(own.rmse.value);
    else
      parts.push_back(fmt::format("as the {} from the {} on, and saves {}", name_map(own),
                                  name_map(family.maps[*each.cached]),
                                  each.pays ? fmt::format("{} of {} {} a frame", records::format_number(each.saved_ms),
                                                          records::format_number(own.frame().value), unit)
                                            : "nothing that can be told"));
  }
  std::string text = fmt::format("{}: map and prefilter are {} of a frame in which the view's own map is drawn",
                                 name_head(family), describe_redrawing(family));
  if (!parts.empty()) text += fmt::format("; a kept map is as accurate {}", fmt::join(parts, "; "));
  if (errors.empty()) return text + ".";
  const auto [least, most] = std::ranges::minmax(errors);
  return fmt::format("{}; no kept map measured (RMSE {} at best) is as accurate as {} (RMSE {}).", text,
                     records::format_number(std::ranges::min(shared_errors)),
                     parts.empty()        ? "any of them"
                     : errors.size() == 1 ? "the other"
                                          : fmt::format("the other {}", errors.size()),
                     errors.size() > 1
                         ? fmt::format("{} to {}", records::format_number(least), records::format_number(most))
                         : records::format_number(least));
}

}  // namespace

std::vector<std::string> describe_layers(const std::vector<MapFamily>& families) {
  std::vector<std::string> sentences;
  for (const MapFamily& family : families) {
    std::map<std::size_t, std::vector<LayerComparison>> of_one_size;  // by the layers
    for (const LayerComparison& each : compare_layers(family)) of_one_size[each.layered].push_back(each);
    for (const auto& [layered, found] : of_one_size) sentences.push_back(describe_layers_of(family, found));
  }
  return sentences;
}

std::vector<std::string> describe_sharing(const std::vector<MapFamily>& families, const records::GlRecord& gl) {
  std::vector<std::string> sentences;
  for (const MapFamily& family : families)
    for (const Sharing& each : find_sharing(family))
      sentences.push_back(
          fmt::format("{}: {}.", name_head(family), describe_sharing_of(family, each, records::time_unit(gl))));
  return sentences;
}

std::vector<std::string> describe_caching(const std::vector<MapFamily>& families, const records::GlRecord& gl) {
  std::vector<std::string> sentences;
  for (const MapFamily& family : families)
    if (const auto found = find_caching(family); !found.empty())
      sentences.push_back(describe_caching_of(family, found, records::time_unit(gl)));
  return sentences;
}

std::vector<std::string> describe_drift(const std::vector<MapFamily>& families) {
  const auto worst = std::ranges::max_element(families, {}, &MapFamily::drift);
  if (worst == families.end() || worst->drift <= kSteady) return {};
  return {
      fmt::format("The machine's speed changed between the maps: of {}, lookups that read no map differ by a factor "
                  "of {}. Costs of different maps are told apart only where they differ by more.",
                  name_head(*worst), records::format_number(worst->drift))};
}

}  // namespace shadowbench::analysis
