#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "report/analysis/light_growth.h"
#include "report/analysis/summary.h"
#include "report/analysis/verdict_places.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr double kLinear = 0.1;  // medians are at most so far from a line, as a share

// One filter's growth in one chart.
struct Grown {
  const LightChart* chart;
  std::string place;
  LightGrowth growth;
};

// Filter, state of the casters, picture and map: what one sentence is about.
using GrowthKey = std::tuple<std::string, LightState, std::string, int>;

std::string name_place(const std::map<std::string, std::set<std::string>>& views, const LightChart& chart) {
  return views.at(chart.scene).size() > 1 ? chart.scene + " (" + chart.view + ")" : chart.scene;
}

std::map<std::string, std::set<std::string>> list_views(const std::vector<LightChart>& charts) {
  std::map<std::string, std::set<std::string>> views;
  for (const LightChart& chart : charts) views[chart.scene].insert(chart.view);
  return views;
}

// "linear within 2 %", "linear within 2 % on a; not linear on b (12 % off a line)"; empty where two counts show
// nothing.
std::string describe_linearity(const std::vector<Grown>& all) {
  double within = 0.0;
  std::vector<std::string> linear, bent;
  for (const Grown& each : all) {
    if (!each.growth.off_line) continue;
    const double off = *each.growth.off_line;
    if (off <= kLinear) {
      within = std::max(within, off);
      linear.push_back(each.place);
    } else {
      bent.push_back(fmt::format("{} ({:.1f} % off a line)", each.place, 100.0 * off));
    }
  }
  std::string text;
  if (!linear.empty()) text += fmt::format(": linear within {:.1f} %", 100.0 * within);
  if (!linear.empty() && linear.size() < all.size()) text += fmt::format(" on {}", fmt::join(linear, ", "));
  if (!bent.empty()) text += fmt::format("{} not linear on {}", text.empty() ? ":" : ";", fmt::join(bent, ", "));
  return text;
}

std::string describe_growth_of(const GrowthKey& key, const std::vector<Grown>& all, const records::GlRecord& gl) {
  const auto& [label, light, picture, map_size] = key;
  std::vector<std::string> slopes;
  for (const Grown& each : all)
    slopes.push_back(fmt::format("{}{} on {}", records::format_number(each.growth.per_light_ms.value),
                                 slopes.empty() ? " " + records::time_unit(gl) : "", each.place));
  return fmt::format("Each further light costs {} with {}, casters {}{} ({} to {} lights, picture {}, map {}).",
                     fmt::join(slopes, ", "), label, light == LightState::kStill ? "still" : "moving",
                     describe_linearity(all), all.front().chart->counts.front(), all.front().chart->counts.back(),
                     picture, map_size);
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
  const auto views = list_views(charts);
  std::vector<GrowthKey> keys;
  std::map<GrowthKey, std::vector<Grown>> grown;
  for (const LightState light : {LightState::kStill, LightState::kMoving}) {
    for (const LightChart& chart : charts) {
      for (const LightCurve& curve : chart.curves) {
        if (curve.points.size() < 2) continue;
        const GrowthKey key(curve.label, light, fmt::format("{} × {}", chart.width, chart.height), chart.map_size);
        std::vector<Grown>& all = grown[key];
        if (all.empty()) keys.push_back(key);
        // Charts of one place that differ in other settings are told apart by their titles.
        const std::string place = name_place(views, chart);
        const bool known = std::ranges::count(all, place, &Grown::place) > 0;
        all.push_back({&chart, known ? chart.title : place, find_light_growth(curve, light)});
      }
    }
  }
  std::vector<std::string> sentences;
  for (const GrowthKey& key : keys) sentences.push_back(describe_growth_of(key, grown.at(key), gl));
  return sentences;
}

std::vector<std::string> describe_light_order(const std::vector<LightChart>& charts) {
  const auto views = list_views(charts);
  std::map<std::string, VerdictPlaces> changes, rests;
  for (const LightChart& chart : charts) {
    const std::string place = name_place(views, chart);
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
