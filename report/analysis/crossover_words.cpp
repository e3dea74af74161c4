#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "report/analysis/crossover.h"
#include "report/analysis/summary.h"
#include "report/analysis/verdict_places.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

std::string list_numbers(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(records::format_number(number));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::vector<double> list_widths_with(const CurveComparison& comparison, int sign) {
  std::vector<double> widths;
  for (std::size_t i = 0; i < comparison.widths.size(); ++i)
    if (comparison.signs[i] == sign) widths.push_back(comparison.widths[i]);
  return widths;
}

// Who is compared, and whether the light moves.
struct Pair {
  std::string prefiltered;
  std::string taps;
  LightState light;

  auto operator<=>(const Pair&) const = default;
};

// Verdict to the places where it was found.
using Verdicts = std::map<std::string, VerdictPlaces>;

std::string describe_pair(const Pair& pair, const Verdicts& verdicts) {
  std::vector<std::string> parts;
  for (const auto& [verdict, places] : verdicts)
    parts.push_back(fmt::format("{}: {}", verdict, describe_places(places)));
  return fmt::format(
      "{}: {} is cheaper than {} {}.",
      pair.light == LightState::kStill ? "Light still (lookup)" : "Light moving (map, prefilter, lookup)",
      pair.prefiltered, pair.taps, fmt::join(parts, "; "));
}

}  // namespace

std::string describe_comparison(const CurveComparison& comparison) {
  const std::vector<double> cheaper = list_widths_with(comparison, -1), even = list_widths_with(comparison, 0);
  const std::string all = list_numbers(comparison.widths);
  const std::string not_apart = even.empty() ? "" : fmt::format(", not to be told apart at {}", list_numbers(even));
  if (cheaper.empty()) return fmt::format("at no width compared ({} texels{})", all, not_apart);
  if (cheaper.size() == comparison.widths.size())
    return fmt::format("at {} compared ({} texels)", cheaper.size() > 1 ? "every width" : "the one width", all);
  const bool to_the_end = comparison.signs.back() == -1;
  const auto first = std::find(comparison.signs.begin(), comparison.signs.end(), -1);
  const bool in_one_piece =
      std::is_partitioned(comparison.signs.begin(), comparison.signs.end(), [](int s) { return s != -1; });
  if (to_the_end && in_one_piece) {
    const double from = comparison.widths[static_cast<std::size_t>(first - comparison.signs.begin())];
    return fmt::format("from a kernel width of {} texels on, of {} compared{}", records::format_number(from), all,
                       not_apart);
  }
  return fmt::format("at {} texels of {} compared{}", list_numbers(cheaper), all, not_apart);
}

std::vector<std::string> describe_crossovers(const std::vector<WidthChart>& charts) {
  std::map<Pair, Verdicts> pairs;
  std::map<std::string, std::set<std::string>> views;
  for (const WidthChart& chart : charts) views[chart.scene].insert(chart.view);
  for (const WidthChart& chart : charts) {
    const std::string place = views[chart.scene].size() > 1 ? chart.scene + " (" + chart.view + ")" : chart.scene;
    const std::string picture = fmt::format("{} × {}", chart.width, chart.height);
    for (const LightState light : {LightState::kStill, LightState::kMoving}) {
      for (const CurveComparison& each : compare_curves(chart, light)) {
        const Pair pair{chart.curves[each.prefiltered].label, chart.curves[each.taps].label, light};
        pairs[pair][describe_comparison(each)][{picture, chart.map_size}].push_back(place);
      }
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [pair, verdicts] : pairs) sentences.push_back(describe_pair(pair, verdicts));
  return sentences;
}

}  // namespace shadowbench::analysis
