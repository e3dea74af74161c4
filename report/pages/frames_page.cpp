#include "report/pages/frames_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "report/analysis/findings.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr int kReferenceTaps = 16;
const char* const kTaps = "taps";

using records::AccumulationRecord;
using records::CellRecord;
using records::ResolveRecord;

const ResolveRecord& find_resolve(const AccumulationRecord& record, const std::string& rule, bool jitter) {
  const auto found = std::ranges::find_if(record.resolves,
                                          [&](const ResolveRecord& r) { return r.rule == rule && r.jitter == jitter; });
  if (found == record.resolves.end() || found->rmse.empty())
    fail_input(
        fmt::format("the accumulation of a cell lacks what frames make of it by the rule '{}' {} jitter: run it again",
                    rule, jitter ? "with" : "without"));
  return *found;
}

std::optional<int> find_taps(const CellRecord& cell) {
  const auto found = cell.params.find(kTaps);
  const double* taps = found == cell.params.end() ? nullptr : std::get_if<double>(&found->second);
  return taps ? std::optional(static_cast<int>(*taps)) : std::nullopt;
}

/// The cell that has 16 taps and is else like this one; null where there is none.
const CellRecord* find_reference(const analysis::CellGroup& group, const CellRecord& cell) {
  records::ParamMap params = cell.params;
  params[kTaps] = double{kReferenceTaps};
  const auto found = std::ranges::find_if(group.cells, [&](const CellRecord& other) {
    return other.accumulation && other.filter == cell.filter && other.params == params;
  });
  return found == group.cells.end() ? nullptr : &*found;
}

std::optional<int> count_frames(const std::vector<double>& values, double limit) {
  const auto found = std::ranges::find_if(values, [&](double value) { return value <= limit; });
  return found == values.end() ? std::nullopt : std::optional(static_cast<int>(found - values.begin()) + 1);
}

std::string say_frames(const std::optional<int>& frames, std::size_t most) {
  return frames ? fmt::format("{}", *frames) : fmt::format("more than {}", most);
}

document::Table make_equivalence_table(const std::vector<analysis::CellGroup>& groups) {
  document::Table table{"Frames, of a plain mean, that equal one frame of 16 taps",
                        {{"scene", "filter", "taps", "frames by noise", "taps in all of them", "frames by error",
                          "noise of one frame", "noise of the last", "RMSE of one frame", "RMSE of the last"},
                         {}}};
  for (const analysis::CellGroup& group : groups) {
    for (const TapEquivalence& each : list_equivalences(group)) {
      const ResolveRecord& mean = *each.mean;
      const std::size_t most = mean.rmse.size();
      table.table.rows.push_back({group.scene, each.filter, fmt::format("{}", each.taps),
                                  say_frames(each.by_noise, most),
                                  each.by_noise ? fmt::format("{}", *each.by_noise * each.taps) : records::kNothing,
                                  say_frames(each.by_error, most), records::format_number(mean.noise->front()),
                                  records::format_number(mean.noise->back()), records::format_number(mean.rmse.front()),
                                  records::format_number(mean.rmse.back())});
    }
  }
  return table;
}

/// What frames gain at most: of the filter whose noise falls by most, or whose error where none has noise.
std::string describe_gain(const std::vector<analysis::CellGroup>& groups, std::size_t frames) {
  std::string text;
  double most = -1.0;
  for (const analysis::CellGroup& group : groups)
    for (const CellRecord& cell : group.cells) {
      if (!cell.accumulation) continue;
      const ResolveRecord& mean = find_resolve(*cell.accumulation, "mean", false);
      const bool is_noisy = mean.noise && mean.noise->front() > 0.0;
      const std::vector<double>& values = is_noisy ? *mean.noise : mean.rmse;
      const double gain = (is_noisy ? 1e3 : 1.0) * (values.front() - values.back());
      if (gain <= most) continue;
      most = gain;
      text = fmt::format("Over {} frames, {} gains most: its {} on {} goes from {} to {}.", frames,
                         group.names.name(cell), is_noisy ? "noise" : "RMSE", cell.scene,
                         records::format_number(values.front()), records::format_number(values.back()));
    }
  return text;
}

/// A sentence for the fewest taps; without fewer than 16 what frames gain.
std::string summarize(const std::vector<analysis::CellGroup>& groups, std::size_t frames) {
  std::vector<TapEquivalence> all;
  for (const analysis::CellGroup& group : groups) std::ranges::copy(list_equivalences(group), std::back_inserter(all));
  std::erase_if(all, [](const TapEquivalence& each) { return each.taps == kReferenceTaps; });
  if (all.empty()) return describe_gain(groups, frames);
  const int fewest = std::ranges::min_element(all, {}, &TapEquivalence::taps)->taps;
  std::vector<int> counts;
  std::set<std::string> late;
  for (const TapEquivalence& each : all) {
    if (each.taps != fewest) continue;
    if (each.by_noise)
      counts.push_back(*each.by_noise);
    else
      late.insert(each.filter);
  }
  std::ranges::sort(counts);
  std::string text = fmt::format("{} taps have the noise of 16 taps in one frame ", fewest);
  if (counts.empty()) return text + fmt::format("after more than {} frames.", frames);
  text += counts.front() == counts.back()
              ? fmt::format("after {} frame{}", counts.front(), counts.front() == 1 ? "" : "s")
              : fmt::format("after {} to {} frames, by scene and rotation", counts.front(), counts.back());
  if (!late.empty()) text += fmt::format(", and after more than {}: {}", frames, fmt::join(late, "; "));
  return text + ".";
}

/// A chart of one number over the frames, a line for each cell.
document::Chart make_chart(const analysis::CellGroup& group, const std::string& y_name,
                           const std::function<const std::vector<double>*(const AccumulationRecord&)>& values) {
  document::Chart chart;
  chart.title = fmt::format("{} on {}", y_name, group.scene);
  chart.id = "frames." + make_file_stem(chart.title);
  chart.x_name = "frames in a plain mean";
  chart.y_name = y_name;
  std::vector<double> xs, ys;
  std::vector<std::pair<double, std::string>> weights;
  document::ChartSeries level{
      .title = "one frame of 16 taps", .color = document::kInk, .line = document::LineStyle::kDashed, .points = {}};
  for (std::size_t i = 0; i < group.cells.size(); ++i) {
    const auto* curve = group.cells[i].accumulation ? values(*group.cells[i].accumulation) : nullptr;
    if (!curve) continue;
    const std::string name = group.names.name(group.cells[i]);
    document::ChartSeries series = document::make_line(name, document::style_of(i));
    for (std::size_t n = 0; n < curve->size(); ++n) {
      if ((*curve)[n] <= 0.0) continue;
      xs.push_back(static_cast<double>(n + 1));
      ys.push_back((*curve)[n]);
      series.points.push_back(document::exact_point(xs.back(), ys.back()));
      series.points.back().details = {name, fmt::format("{} frames: {}", n + 1, records::format_number(ys.back()))};
    }
    const auto& noise = find_resolve(*group.cells[i].accumulation, "mean", false).noise;
    weights.emplace_back(noise ? noise->front() : 0.0, name);  // the same ones in both charts
    if (level.points.empty() && find_taps(group.cells[i]) == kReferenceTaps && curve->front() > 0.0)
      level.points = {document::exact_point(1.0, curve->front()),
                      document::exact_point(static_cast<double>(curve->size()), curve->front())};
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  if (!level.points.empty()) chart.series.push_back(std::move(level));
  chart.x = document::choose_log_axis(xs, {});
  chart.y = document::choose_log_axis(ys, {});
  document::show_most_telling(chart, std::move(weights));
  return chart;
}

/// Of noise and error, the one that all groups have comes first.
document::ChartChoice make_charts(const std::vector<analysis::CellGroup>& groups) {
  using Values = const std::vector<double>* (*)(const AccumulationRecord&);
  std::vector<std::pair<const char*, Values>> kinds = {
      {"noise",
       [](const AccumulationRecord& record) {
         const auto& noise = find_resolve(record, "mean", false).noise;
         return noise ? &*noise : nullptr;
       }},
      {"RMSE", [](const AccumulationRecord& record) { return &find_resolve(record, "mean", false).rmse; }}};
  if (std::ranges::any_of(groups,
                          [&](const auto& group) { return make_chart(group, "", kinds[0].second).series.empty(); }))
    std::ranges::reverse(kinds);
  document::ChartChoice choice{"frames", {{"of", {}}, {"shown", {kinds[0].first, kinds[1].first}}}, {}};
  for (const analysis::CellGroup& group : groups) {
    choice.selectors[0].options.push_back(
        fmt::format("{}, {}", group.scene, records::describe_settings(group.cells.front())));
    for (const auto& [name, values] : kinds) choice.charts.push_back(make_chart(group, name, values));
  }
  return choice;
}

document::Table make_resolve_table(const analysis::CellGroup& group) {
  document::Table table{
      "After the last frame, and flicker in the second half of the frames",
      {{"filter", "rule", "RMSE, still", "flicker, still", "RMSE, jitter", "flicker, jitter", "noise, still"}, {}}};
  for (const CellRecord& cell : group.cells) {
    if (!cell.accumulation) continue;
    for (const ResolveRecord& still : cell.accumulation->resolves) {
      if (still.jitter) continue;
      const ResolveRecord& moved = find_resolve(*cell.accumulation, still.rule, true);
      table.table.rows.push_back({group.names.name(cell), still.rule, records::format_number(still.rmse.back()),
                                  records::format_number(still.flicker), records::format_number(moved.rmse.back()),
                                  records::format_number(moved.flicker),
                                  still.noise ? records::format_number(still.noise->back()) : records::kNothing});
    }
  }
  return table;
}

std::string say_ghost(const records::GhostRecord& ghost) {
  if (!ghost.at_stop) return "no pixel";
  const std::string until =
      ghost.frames_until ? fmt::format("{}", *ghost.frames_until) : std::string("more than the 64 followed");
  return fmt::format("{} (from {})", until, records::format_number(ghost.at_stop));
}

document::Table make_ghost_table(const analysis::CellGroup& group) {
  document::Table table{
      fmt::format("Ghosting: frames at rest until the mean error behind a shadow's edge is {:g} or less, and what it "
                  "was as the shadow stopped",
                  records::kGhostLimit),
      {{"filter"}, {}}};
  for (const CellRecord& cell : group.cells) {
    if (!cell.accumulation || cell.accumulation->ghosts.empty()) continue;
    std::vector<std::string>& row = table.table.rows.emplace_back(std::vector{group.names.name(cell)});
    for (const records::GhostRecord& ghost : cell.accumulation->ghosts) {
      if (table.table.rows.size() == 1)
        table.table.header.push_back(
            fmt::format("{:g} {} a frame, {}", ghost.texels, ghost.texels == 1.0 ? "texel" : "texels", ghost.rule));
      row.push_back(say_ghost(ghost));
    }
  }
  return table;
}

document::Section make_group_section(const analysis::CellGroup& group, const records::RunRecord& run) {
  const CellRecord& any = *std::ranges::find_if(group.cells, [](const auto& cell) { return !!cell.accumulation; });
  document::Section section{make_file_stem(group.scene + "-" + any.key), group.scene, {}};
  section.blocks.emplace_back(document::Paragraph{records::describe_settings(any), true});
  section.blocks.emplace_back(make_resolve_table(group));
  if (any.accumulation->no_ghosts.empty())
    section.blocks.emplace_back(make_ghost_table(group));
  else
    section.blocks.emplace_back(document::Paragraph{"No ghosting was measured: " + any.accumulation->no_ghosts + "."});
  section.blocks.emplace_back(document::Paragraph{
      fmt::format("The pass that accumulates takes {} ms, with clamping {} ms ({}); it is in no other time.",
                  records::format_number(any.accumulation->exponential_ms),
                  records::format_number(any.accumulation->clamped_ms), records::describe_clock(run.gl)),
      true});
  const auto drawn = std::ranges::find_if(
      group.cells, [](const CellRecord& cell) { return cell.accumulation && cell.accumulation->picture; });
  if (drawn != group.cells.end())
    section.blocks.emplace_back(
        document::Gallery{{}, {{*drawn->accumulation->picture, "accumulated visibility and its error, by rule"}}});
  return section;
}

std::vector<std::string> define_terms() {
  return {
      "Each frame turns the taps: white noise is drawn anew, blue noise and interleaved gradient noise turn on by the "
      "golden ratio. A filter whose rotation is none draws the same frame again and again.",
      "Newest is the last frame alone; mean the plain mean of all; exponential gives each frame a weight of 0.1, at "
      "first 1/n; clamped does so too, and keeps what was accumulated within the 3x3 pixels of the newest frame.",
      "With jitter the camera takes eight places within a pixel in turn, and RMSE is to the mean of the truth over "
      "these; without, it stands still, and RMSE is to the truth at the pixel's middle, as everywhere in the report.",
      "Noise is the RMS difference, over receivers, from the mean of 256 other frames of the same filter.",
      "Flicker is the RMS change of visibility from one frame to the next while nothing but taps and jitter moves.",
      "Ghosting: the light turns about the vertical for eight frames, so fast that the median shadow moves by so many "
      "texels a frame, and stops. Behind an edge are the pixels that were dark before and are lit after that, and "
      "that the filter itself sees lit at rest."};
}

}  // namespace

std::vector<TapEquivalence> list_equivalences(const analysis::CellGroup& group) {
  std::vector<TapEquivalence> list;
  for (const CellRecord& cell : group.cells) {
    const std::optional<int> taps = find_taps(cell);
    const CellRecord* reference = taps ? find_reference(group, cell) : nullptr;
    if (!cell.accumulation || !reference) continue;
    const ResolveRecord& mean = find_resolve(*cell.accumulation, "mean", false);
    const ResolveRecord& limit = find_resolve(*reference->accumulation, "mean", false);
    if (!mean.noise || !limit.noise || limit.noise->front() == 0.0) continue;
    list.push_back({group.names.name(cell), *taps, &mean, count_frames(*mean.noise, limit.noise->front()),
                    count_frames(mean.rmse, limit.rmse.front())});
  }
  return list;
}

document::Page make_frames_page(const std::vector<CellRecord>& cells, const records::RunRecord& run) {
  std::vector<analysis::CellGroup> groups = analysis::group_cells(cells);
  std::erase_if(
      groups,
      [](const analysis::CellGroup& group) {
        return std::ranges::none_of(
            group.cells, [](const CellRecord& cell) { return !!cell.accumulation; });
      });
  const auto accumulated = std::ranges::find_if(cells, [](const CellRecord& cell) { return !!cell.accumulation; });
  const std::size_t frames = find_resolve(*accumulated->accumulation, "mean", false).rmse.size();
  document::Page page{fmt::format("Frames: what accumulation over {} of them makes of each filter", frames), {}, {}};
  document::Section answer{"answer", "", {document::Paragraph{summarize(groups, frames)}}};
  if (document::Table table = make_equivalence_table(groups); !table.table.rows.empty())
    answer.blocks.emplace_back(std::move(table));
  answer.blocks.emplace_back(make_charts(groups));
  page.sections.push_back(std::move(answer));
  for (const analysis::CellGroup& group : groups) page.sections.push_back(make_group_section(group, run));
  page.sections.push_back(
      {"data",
       "",
       {document::Details{"Machine and terms",
                          {document::Facts{analysis::list_run_facts(run)}, document::Sentences{{}, define_terms()}}}}});
  return page;
}

}  // namespace shadowbench::pages
