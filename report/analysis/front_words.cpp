#include "report/analysis/front_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "filters/kernel_width.h"
#include "report/analysis/summary.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr std::size_t kNamed = 4;      // cells that one sentence names; fronts.csv has all
constexpr std::size_t kEachNamed = 8;  // above, cells are counted by filter
constexpr std::size_t kBeatersNamed = 2;

const std::string& label_of(const TradeScope& scope, const TradeFront& front, std::size_t point) {
  return scope.configurations[front.configurations[point]].label;
}

std::string unit_of(const Measure& measure, const records::GlRecord& gl) {
  return measure.is_time ? fmt::format(" {}", records::time_unit(gl)) : std::string();
}

std::string describe_member(const TradeScope& scope, const TradeFront& front, std::size_t point,
                            const records::GlRecord& gl) {
  const Measure& error = list_error_measures()[front.error];
  const Measure& cost = list_cost_measures()[front.cost];
  return fmt::format("{} ({} at {}{})", label_of(scope, front, point),
                     format_estimate(error, front.points[point].error), format_estimate(cost, front.points[point].cost),
                     unit_of(cost, gl));
}

std::vector<std::string> list_placed(const TradeScope& scope, const TradeFront& front, Standing standing,
                                     std::size_t by) {
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < front.placements.size(); ++i)
    if (front.placements[i].standing == standing && front.placements[i].by == by)
      labels.push_back(label_of(scope, front, i));
  return labels;
}

std::string join_some(const std::vector<std::string>& labels) {
  if (labels.size() <= kNamed + 1) return fmt::format("{}", fmt::join(labels, ", "));
  return fmt::format("{} and {} more", fmt::join(labels.begin(), labels.begin() + kNamed, ", "),
                     labels.size() - kNamed);
}

std::string name_placed(const TradeScope& scope, const TradeFront& front, Standing standing, const char* verb) {
  std::vector<std::string> parts;
  for (const std::size_t member : front.members) {
    const auto labels = list_placed(scope, front, standing, member);
    if (!labels.empty())
      parts.push_back(fmt::format("{} {} {}", label_of(scope, front, member), verb, join_some(labels)));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

const std::string& filter_of(const TradeScope& scope, const TradeFront& front, std::size_t point) {
  return scope.configurations[front.configurations[point]].filter;
}

// "all 40 of esm, 12 of 15 of poisson, pcf2x2": a filter that has one cell is only named. Filters stand in the scope's
// order.
std::string count_by_filter(const TradeScope& scope, const TradeFront& front, Standing standing) {
  std::vector<std::string> parts, told;
  for (std::size_t i = 0; i < front.points.size(); ++i) {
    const std::string& filter = filter_of(scope, front, i);
    if (std::ranges::count(told, filter) > 0) continue;
    told.push_back(filter);
    std::size_t all = 0, placed = 0;
    for (std::size_t j = 0; j < front.points.size(); ++j) {
      if (filter_of(scope, front, j) != filter) continue;
      ++all;
      placed += front.placements[j].standing == standing ? 1 : 0;
    }
    if (placed == 0) continue;
    if (all == 1)
      parts.push_back(filter);
    else
      parts.push_back(placed == all ? fmt::format("all {} of {}", all, filter)
                                    : fmt::format("{} of {} of {}", placed, all, filter));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Why the dominated are beaten: in which of the two they are clearly worse.
std::string count_reasons(const TradeFront& front) {
  std::size_t both = 0, cost = 0, error = 0;
  for (std::size_t i = 0; i < front.points.size(); ++i) {
    if (front.placements[i].standing != Standing::kDominated) continue;
    const FrontPoint& beater = front.points[front.placements[i].by];
    const bool dearer = is_clearly_less_cost(beater.cost, front.points[i].cost);
    const bool worse = is_clearly_less_error(beater.error, front.points[i].error);
    ++(dearer && worse ? both : dearer ? cost : error);
  }
  std::vector<std::string> parts;
  if (both > 0) parts.push_back(fmt::format("{} cost more and err more", both));
  if (cost > 0) parts.push_back(fmt::format("{} cost more for no less error", cost));
  if (error > 0) parts.push_back(fmt::format("{} err more for no less cost", error));
  return fmt::format("Of these, {}.", fmt::join(parts, ", "));
}

// The members that beat the most cells; the cheaper of two that beat as many comes first.
std::string count_beaten(const TradeScope& scope, const TradeFront& front) {
  std::vector<std::pair<std::size_t, std::size_t>> beaten;
  for (const std::size_t member : front.members)
    beaten.emplace_back(member, list_placed(scope, front, Standing::kDominated, member).size());
  std::ranges::stable_sort(beaten, std::greater(), &std::pair<std::size_t, std::size_t>::second);
  std::erase_if(beaten, [](const auto& each) { return each.second == 0; });
  beaten.resize(std::min(beaten.size(), kBeatersNamed));
  std::vector<std::string> parts;
  for (const auto& [member, count] : beaten)
    parts.push_back(fmt::format("{} beats {}", label_of(scope, front, member), count));
  return fmt::format("{}; fronts.csv has each.", fmt::join(parts, ", "));
}

std::size_t count_standing(const TradeFront& front, Standing standing) {
  std::size_t count = 0;
  for (const Placement& each : front.placements) count += each.standing == standing ? 1 : 0;
  return count;
}

void describe_ties(std::vector<std::string>& sentences, const TradeScope& scope, const TradeFront& front) {
  const std::size_t tied = count_standing(front, Standing::kTied);
  if (tied == 0) return;
  sentences.push_back(
      tied <= kEachNamed
          ? fmt::format("Not to be told apart in error or cost: {}.",
                        name_placed(scope, front, Standing::kTied, "is tied with"))
          : fmt::format("Not to be told apart in error or cost from a cell of the front are {} of {}: {}.", tied,
                        front.points.size(), count_by_filter(scope, front, Standing::kTied)));
}

void describe_dominated(std::vector<std::string>& sentences, const TradeScope& scope, const TradeFront& front) {
  const std::size_t dominated = count_standing(front, Standing::kDominated);
  if (dominated == 0) return;
  const bool each = dominated <= kEachNamed;
  const std::string who = each ? name_placed(scope, front, Standing::kDominated, "beats")
                               : count_by_filter(scope, front, Standing::kDominated);
  sentences.push_back(fmt::format("Dominated are {} of {}: {}.", dominated, front.points.size(), who));
  if (!each) sentences.back() += fmt::format(" {} {}", count_reasons(front), count_beaten(scope, front));
}

// Neighbours on the front, whose errors differ clearly.
std::string describe_uncertain_steps(const TradeScope& scope, const TradeFront& front) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i + 1 < front.members.size(); ++i) {
    const std::size_t a = front.members[i], b = front.members[i + 1];
    if (front.points[a].group != front.points[b].group) continue;
    if (is_clearly_less_cost(front.points[a].cost, front.points[b].cost)) continue;
    parts.push_back(fmt::format("{} and {}", label_of(scope, front, a), label_of(scope, front, b)));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

// One sentence for each class of width that has a front.
void describe_members(std::vector<std::string>& sentences, const TradeScope& scope, const TradeFront& front,
                      const records::GlRecord& gl) {
  const auto& classes = filters::width_classes();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    std::vector<std::string> members;
    for (const std::size_t member : front.members)
      if (front.points[member].group == i) members.push_back(describe_member(scope, front, member, gl));
    if (members.empty()) continue;
    sentences.push_back(fmt::format("{} against {}, {} kernels, the front from the cheapest cell on: {}.",
                                    list_error_measures()[front.error].name, list_cost_measures()[front.cost].name,
                                    classes[i].name, fmt::join(members, "; ")));
  }
}

void describe_apart(std::vector<std::string>& sentences, const TradeScope& scope, const TradeFront& front) {
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < front.placements.size(); ++i)
    if (front.placements[i].standing == Standing::kApart) labels.push_back(label_of(scope, front, i));
  if (labels.empty()) return;
  sentences.push_back(fmt::format("Compared with nothing, for their kernels are of no class, too wide or unknown: {}.",
                                  join_some(labels)));
}

std::vector<std::string> describe_left_out(const TradeScope& scope, const TradeFront& front) {
  std::vector<std::string> sentences;
  for (const auto& [reason, count] : front.left_out)
    sentences.push_back(fmt::format("Left out: {} of {} ({}).", count, scope.configurations.size(), reason));
  if (scope.incomplete > 0)
    sentences.push_back(fmt::format("Left out: {} that not every scene and view has a cell of.", scope.incomplete));
  return sentences;
}

}  // namespace

std::vector<std::string> describe_front(const TradeScope& scope, const TradeFront& front, const records::GlRecord& gl) {
  std::vector<std::string> sentences;
  if (front.points.empty()) {
    sentences.push_back(fmt::format("No cell has both {} and {}.", list_error_measures()[front.error].name,
                                    list_cost_measures()[front.cost].name));
  }
  describe_members(sentences, scope, front, gl);
  const std::string steps = describe_uncertain_steps(scope, front);
  if (!steps.empty())
    sentences.push_back("Neighbours whose costs cannot be told apart, so that the smaller error may be free: " + steps +
                        ".");
  describe_ties(sentences, scope, front);
  describe_dominated(sentences, scope, front);
  describe_apart(sentences, scope, front);
  const auto left_out = describe_left_out(scope, front);
  sentences.insert(sentences.end(), left_out.begin(), left_out.end());
  return sentences;
}

std::vector<std::string> explain_fronts() {
  std::vector<std::string> sentences = {
      fmt::format(
          "Only filters whose kernels are about equally wide are compared: a wider kernel makes a softer shadow, "
          "and is no worse filter. A kernel's width is its standard deviation along an axis, in texels; each "
          "class has a front of its own: {}.",
          filters::describe_classes()),
      "A cell of the front beats another of its class, which is then dominated, where it costs no more, its error is "
      "not clearly larger, and one of the two is clearly less. A cell is tied with one of the front where neither is "
      "clearly less. Clearly: errors that differ by more than half the wider 95 % interval over the phases of the "
      "map's "
      "grid, times whose 95 % intervals do not overlap, everything else where the numbers differ. Of several that beat "
      "a "
      "cell, the cheapest is named."};
  for (const Measure& measure : list_error_measures()) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.name, measure.meaning, measure.over_scenes));
  }
  for (const Measure& measure : list_cost_measures()) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.name, measure.meaning, measure.over_scenes));
  }
  return sentences;
}

}  // namespace shadowbench::analysis
