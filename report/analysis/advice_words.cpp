#include "report/analysis/advice_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::analysis {
namespace {

std::string list_settings_that_vary(const std::set<std::string>& values) {
  return values.size() > 1 ? fmt::format("{}", fmt::join(values, ", ")) : "";
}

// Settings that belong to the question more than to the answer.
void add_setting_notes(std::vector<std::string>& notes, const std::vector<const records::CellRecord*>& cells) {
  if (std::ranges::any_of(cells, [](const records::CellRecord* cell) {
        const records::BiasRecord& bias = cell->bias;
        return bias.constant.world > 0.0 || bias.slope.world > 0.0 || bias.normal_offset.world > 0.0;
      }))
    notes.emplace_back("A bias in metres is right for one texel size alone: in texels it follows the map.");
  std::set<std::string> sizes, lights;
  for (const records::CellRecord* cell : cells) {
    sizes.insert(fmt::format("{}x{}", cell->width, cell->height));
    lights.insert(cell->light);
  }
  if (const std::string list = list_settings_that_vary(sizes); !list.empty()) {
    notes.push_back(
        fmt::format("Pictures of {} pixels compete here, and a smaller one costs less: --size chooses.", list));
  }
  if (const std::string list = list_settings_that_vary(lights); !list.empty())
    notes.push_back(fmt::format("Lights at {} compete here, as if a renderer could choose.", list));
}

std::string list_names(const std::vector<Candidate>& candidates) {
  constexpr std::size_t kMostNamed = 8;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(kMostNamed, candidates.size()); ++i)
    names.push_back(candidates[i].configuration.name);
  if (names.size() < candidates.size()) names.push_back(fmt::format("and {} more", candidates.size() - names.size()));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<const records::CellRecord*> list_judged_cells(const Advice& advice) {
  std::vector<const records::CellRecord*> cells;
  for (const auto* candidates : {&advice.keeping, &advice.beaten, &advice.no_gain, &advice.failing})
    for (const Candidate& candidate : *candidates)
      cells.insert(cells.end(), candidate.configuration.cells.begin(), candidate.configuration.cells.end());
  return cells;
}

bool uses_time(const AdviceRequest& request) {
  return request.cheapest == CostKind::kTime ||
         std::ranges::any_of(
             request.demands, [](const Demand& d) { return d.spec == &cost_spec(CostKind::kTime); });
}

void add_time_notes(std::vector<std::string>& notes, const std::vector<const records::CellRecord*>& cells,
                    const records::GlRecord& gl) {
  const std::vector<std::string> gpus = list_gpus(cells);
  if (gl.software)
    notes.push_back(
        fmt::format("Times are {}: a GPU ranks filters differently{}.", records::describe_clock(gl),
                    gpus.empty() ? "" : fmt::format("; there are estimates for {}", fmt::join(gpus, ", "))));
  const bool once = std::ranges::any_of(
      cells, [](const records::CellRecord* c) { return c->time_ms.lookup && c->time_ms.lookup->n < 2; });
  if (once) notes.push_back("Times of a single round have no spread, so their order may be chance: raise --rounds.");
}

// Where a limit could not be broken: by the advised one, or, where there is none, by any that was judged.
void add_notes_of_nothing_to_see(std::vector<std::string>& notes, const Advice& advice) {
  const bool fits = !advice.keeping.empty();
  const std::vector<Candidate>& judged = fits ? advice.keeping : advice.failing;
  for (std::size_t i = 0; i < advice.request.demands.size(); ++i) {
    std::vector<std::string> places;
    std::string reason;
    for (const Candidate& candidate : judged) {
      for (const records::CellRecord* cell : candidate.verdicts[i].nothing_to_see) {
        const std::string place = describe_place(place_of(*cell), advice.places);
        if (std::ranges::count(places, place) == 0) places.push_back(place);
        if (reason.empty()) reason = records::explain_absence(*cell, advice.request.demands[i].spec->field);
      }
      if (fits) break;
    }
    if (places.empty()) continue;
    notes.push_back(fmt::format("{} could not be judged on {}, and cannot be broken there: {}.",
                                describe_demand(advice.request.demands[i]), fmt::join(places, ", "), reason));
  }
}

std::string describe_left_out(const LeftOutPlace& left_out, const Advice& advice) {
  std::vector<Place> all = advice.places;
  for (const LeftOutPlace& each : advice.left_out) all.push_back(each.place);
  return fmt::format("{} {}", describe_place(left_out.place, all), describe_state(left_out.state));
}

// What holds whatever the limits are: who is left out, what times are, which settings compete.
std::vector<std::string> list_run_notes(const Advice& advice, const records::GlRecord& gl) {
  std::vector<std::string> notes;
  if (!advice.teaching.empty()) {
    notes.push_back(
        fmt::format("Left out, for they show a mistake and are for teaching: {}.", fmt::join(advice.teaching, ", ")));
  }
  const bool is_said = !describe_judged_lights(advice).empty();  // of what was not tested
  for (const LeftOutPlace& each : advice.left_out)
    if (each.is_tested() || !is_said) notes.push_back(describe_left_out(each, advice) + ".");
  const std::vector<const records::CellRecord*> cells = list_judged_cells(advice);
  if (uses_time(advice.request)) add_time_notes(notes, cells, gl);
  add_setting_notes(notes, cells);
  return notes;
}

}  // namespace

std::string format_cost(double value, const CostKind& cost, const records::GlRecord& gl) {
  switch (cost.kind) {
    case CostKind::kTime: return fmt::format("{} {}", records::format_number(value), records::time_unit(gl));
    case CostKind::kBytes: return records::format_bytes(value);
    case CostKind::kFetches:
      return fmt::format("{} {}", records::format_number(value), value == 1.0 ? "fetch" : "fetches");
    case CostKind::kGpu: break;
  }
  const bool is_short = value < 1.0;
  return fmt::format("{} {} estimated for {}", records::format_number(is_short ? 1e3 * value : value),
                     is_short ? "µs" : "ms", cost.gpu);
}

std::string format_within(double value, double low, double high) {
  std::string text = records::format_number(value);
  const auto fits = [&] { return std::stod(text) >= low && std::stod(text) <= high; };
  for (int digits = 3; digits <= 17 && !fits(); ++digits) {
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1.0 - digits);
    text = fmt::format("{:.{}g}", value, digits);
    if (!fits()) text = fmt::format("{:.{}g}", value + unit, digits);
  }
  return text;
}

std::string describe_frame(const AdviceRequest& request) {
  if (!request.cheapest.is_of_frame()) return "";
  if (request.cheapest.kind == CostKind::kGpu)
    return fmt::format(" of a {}x{} frame, {} light", records::kGpuFrameWidth, records::kGpuFrameHeight,
                       request.light == LightMotion::kMoving ? "moving" : "static");
  return request.light == LightMotion::kMoving ? " a frame, moving light" : " a frame, static light";
}

std::string describe_cost(const Advice& advice) {
  const AdviceRequest& request = advice.request;
  const auto* counted = cost_spec(request.cheapest).metric;
  return fmt::format("Cost: {}.",
                     counted ? std::string(counted->definition)
                             : make_frame_measure(request.cheapest, request.light, list_judged_cells(advice)).meaning);
}

std::string describe_broken(const Advice& advice, const Candidate& candidate) {
  std::vector<std::string> broken;
  for (std::size_t i = 0; i < candidate.verdicts.size(); ++i) {
    if (candidate.verdicts[i].kept) continue;
    const auto worst = candidate.verdicts[i].worst;
    broken.push_back(describe_demand(advice.request.demands[i]) + (worst ? " with " + format_limit(*worst) : ""));
  }
  return fmt::format("{}", fmt::join(broken, " and "));
}

JudgedLights count_judged_lights(const Advice& advice) {
  std::set<std::string> tested, all;
  for (const Place& place : advice.places) tested.insert(place.scene);
  for (const LeftOutPlace& each : advice.left_out) (each.is_tested() ? tested : all).insert(each.place.scene);
  all.insert(tested.begin(), tested.end());
  return {tested.size(), all.size()};
}

std::string describe_judged_lights(const Advice& advice) {
  const auto [judged, of] = count_judged_lights(advice);
  if (judged == of) return {};
  std::vector<std::string> untested;
  for (const LeftOutPlace& each : advice.left_out)
    if (!each.is_tested()) untested.push_back(describe_left_out(each, advice));
  return fmt::format("{} of {} lights judged; {}", judged, of, fmt::join(untested, "; "));
}

std::string describe_failure(const Advice& advice) {
  assert(advice.keeping.empty());
  if (advice.places.empty()) return describe_judged_lights(advice);
  const std::size_t total = advice.failing.size() + advice.unjudged.size();
  if (advice.failing.empty())
    return fmt::format("none of {} configurations can be judged: {}", total, fmt::join(count_unjudged(advice), "; "));
  return fmt::format("none of {} configurations keeps the limits; {} comes closest, and breaks {}", total,
                     advice.failing.front().configuration.name, describe_broken(advice, advice.failing.front()));
}

std::vector<std::string> list_advice_notes(const Advice& advice, const records::GlRecord& gl) {
  std::vector<std::string> notes;
  if (!advice.no_gain.empty())
    notes.push_back(fmt::format("No error limit set; left out as no better than {}: {}.", advice.unfiltered,
                                list_names(advice.no_gain)));
  if (!advice.beaten.empty())
    notes.push_back(
        fmt::format("Left out, as another is no dearer and has no larger RMSE: {}.", list_names(advice.beaten)));
  for (std::string& note : list_run_notes(advice, gl)) notes.push_back(std::move(note));
  add_notes_of_nothing_to_see(notes, advice);
  if (advice.keeping.empty()) return notes;
  for (const records::CellRecord* cell : advice.keeping.front().configuration.cells) {
    if (cell->nan.value_or(0) == 0) continue;
    notes.push_back(fmt::format("{} pixels of it on {} are not finite, and are left out of every number here.",
                                *cell->nan, describe_place(place_of(*cell), advice.places)));
  }
  return notes;
}

std::vector<std::string> count_unjudged(const Advice& advice) {
  std::vector<std::pair<std::string, int>> counts;
  for (const Unjudged& unjudged : advice.unjudged) {
    const auto found = std::ranges::find(counts, unjudged.reason, &std::pair<std::string, int>::first);
    if (found == counts.end())
      counts.emplace_back(unjudged.reason, 1);
    else
      ++found->second;
  }
  std::vector<std::string> texts;
  for (const auto& [reason, count] : counts) texts.push_back(fmt::format("{}: {}", count, reason));
  return texts;
}

}  // namespace shadowbench::analysis
