#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "report/analysis/light_growth.h"
#include "report/analysis/summary.h"
#include "report/analysis/verdict_places.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

std::vector<const LightCurve*> list_growing(const LightChart& chart) {
  std::vector<const LightCurve*> curves;
  for (const LightCurve& curve : chart.curves)
    if (curve.points.size() > 1) curves.push_back(&curve);
  return curves;
}

std::string describe_growth_of(const LightChart& chart, const std::vector<const LightCurve*>& curves, LightState light,
                               const records::GlRecord& gl) {
  std::vector<std::string> slopes, exponents;
  for (const LightCurve* curve : curves) {
    const LightGrowth growth = find_light_growth(*curve, light);
    slopes.push_back(fmt::format("{} {}", curve->label, format_time(growth.per_light_ms)));
    exponents.push_back(fmt::format("{} {}", curve->label, format_exponent(growth.exponent)));
  }
  return fmt::format(
      "{}, {} to {} lights, casters {}: each added light costs, in {}: {}; a frame's time grows with the lights to the "
      "power of (1 would be in "
      "proportion): {}.",
      chart.title, chart.counts.front(), chart.counts.back(),
      light == LightState::kStill ? "still (a lookup per light)" : "moving (a map, a prefilter and a lookup per light)",
      records::time_unit(gl), fmt::join(slopes, "; "), fmt::join(exponents, "; "));
}

std::vector<int> list_counts_with(const LightComparison& comparison, const std::vector<int>& signs, int sign) {
  std::vector<int> counts;
  for (std::size_t i = 0; i < signs.size(); ++i)
    if (signs[i] == sign) counts.push_back(comparison.counts[i]);
  return counts;
}

std::string name_lights(const std::vector<int>& counts) {
  return fmt::format("{} light{}", fmt::join(counts, ", "), counts == std::vector{1} ? "" : "s");
}

// Where `a` is cheaper, and what holds elsewhere: "from 2 lights on, of 1, 2, 4 (not to be told apart at 1)".
std::string describe_signs(const LightComparison& comparison, const std::vector<int>& signs) {
  const auto cheaper = list_counts_with(comparison, signs, -1), dearer = list_counts_with(comparison, signs, 1),
             even = list_counts_with(comparison, signs, 0);
  const std::string all = fmt::format("{}", fmt::join(comparison.counts, ", "));
  if (cheaper.size() == signs.size())
    return fmt::format("at {}{}", signs.size() > 1 ? "each of " : "", name_lights(comparison.counts));
  std::vector<std::string> others;
  if (!dearer.empty()) others.push_back(fmt::format("dearer at {}", fmt::join(dearer, ", ")));
  if (!even.empty()) others.push_back(fmt::format("not to be told apart at {}", fmt::join(even, ", ")));
  const bool from_one_on = std::is_partitioned(signs.begin(), signs.end(), [](int sign) { return sign != -1; });
  const std::string where = cheaper.empty() ? fmt::format("at none of {}", name_lights(comparison.counts))
                            : from_one_on   ? fmt::format("from {} on, of {}", name_lights({cheaper.front()}), all)
                                            : fmt::format("at {}, of {}", name_lights(cheaper), all);
  return fmt::format("{} ({})", where, fmt::join(others, ", "));
}

// The other way round: the filter that is cheaper first, with the fewest lights and casters still, is named first.
LightComparison turn_round(const LightComparison& comparison) {
  std::vector<int> signs = comparison.still;
  signs.insert(signs.end(), comparison.moving.begin(), comparison.moving.end());
  const auto first = std::find_if(signs.begin(), signs.end(), [](int sign) { return sign != 0; });
  if (first == signs.end() || *first < 0) return comparison;
  LightComparison turned{comparison.b, comparison.a, comparison.counts, comparison.still, comparison.moving};
  for (std::vector<int>* each : {&turned.still, &turned.moving})
    for (int& sign : *each) sign = -sign;
  return turned;
}

std::string describe_change(const LightChart& chart, const LightComparison& found) {
  const LightComparison comparison = turn_round(found);
  return fmt::format("{} is cheaper than {} with casters still {}; with casters moving {}",
                     chart.curves[comparison.a].label, chart.curves[comparison.b].label,
                     describe_signs(comparison, comparison.still), describe_signs(comparison, comparison.moving));
}

std::string count_pairs(std::size_t count) { return fmt::format("{} pair{} of filters", count, count == 1 ? "" : "s"); }

std::string describe_rest(const std::vector<LightComparison>& comparisons) {
  const auto changing = static_cast<std::size_t>(std::count_if(
      comparisons.begin(), comparisons.end(), [](const auto& each) { return each.changes(); }));
  const auto apart = static_cast<std::size_t>(
      std::count_if(comparisons.begin(), comparisons.end(), [](const auto& each) { return each.is_apart(); }));
  std::vector<std::string> parts = {
      changing == 0 ? "none changes its order" : fmt::format("{} change{} order", changing, changing == 1 ? "s" : "")};
  if (apart > changing)
    parts.push_back(fmt::format("{} keep{} it wherever the two can be told apart", apart - changing,
                                apart - changing == 1 ? "s" : ""));
  if (comparisons.size() > apart)
    parts.push_back(fmt::format("{} cannot be told apart anywhere", comparisons.size() - apart));
  return fmt::format("Of {}, over all numbers of lights, casters still and moving, {}", count_pairs(comparisons.size()),
                     fmt::join(parts, ", "));
}

}  // namespace

std::vector<std::string> describe_light_growth(const std::vector<LightChart>& charts, const records::GlRecord& gl) {
  std::vector<std::string> sentences;
  for (const LightChart& chart : charts) {
    const auto curves = list_growing(chart);
    if (curves.empty()) continue;
    for (const LightState light : {LightState::kStill, LightState::kMoving})
      sentences.push_back(describe_growth_of(chart, curves, light, gl));
  }
  return sentences;
}

std::vector<std::string> describe_light_order(const std::vector<LightChart>& charts) {
  std::map<std::string, std::set<std::string>> views;
  for (const LightChart& chart : charts) views[chart.scene].insert(chart.view);
  std::map<std::string, VerdictPlaces> changes, rests;
  for (const LightChart& chart : charts) {
    const std::string place = views[chart.scene].size() > 1 ? chart.scene + " (" + chart.view + ")" : chart.scene;
    const std::pair key(fmt::format("{} × {}", chart.width, chart.height), chart.map_size);
    const auto comparisons = compare_light_curves(chart);
    for (const LightComparison& each : comparisons)
      if (each.changes()) changes[describe_change(chart, each)][key].push_back(place);
    if (!comparisons.empty()) rests[describe_rest(comparisons)][key].push_back(place);
  }
  std::vector<std::string> sentences;
  for (const auto* verdicts : {&changes, &rests})
    for (const auto& [verdict, places] : *verdicts)
      sentences.push_back(fmt::format("{}: {}.", verdict, describe_places(places)));
  return sentences;
}

}  // namespace shadowbench::analysis
