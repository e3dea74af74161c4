#include "report/pages/flicker_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr double kFar = 0.5;     // flicker below this share of its limit is far from it
constexpr double kAlways = 2.0;  // shown at first: no filter flickers as much
constexpr double kPictureStep = 1.0 / 255.0;
constexpr const char* kFlickerNote =
    "x: times the truth's own change, which a still image would score. \u2717: no less than that, or, where the truth "
    "stands still, no less than 1/255, a step of a picture.";

using Filters = std::vector<records::FlickerFilter>;

/// What flickers less than this, which is one receiver that flips once, is called rounding.
double find_least(const records::FlickerMotion& motion) {
  return 1.0 / std::sqrt(static_cast<double>(motion.receivers) *
                         static_cast<double>(std::max<std::size_t>(1, motion.truth.step_change.size())));
}

/// Flicker in what it is judged by: the truth's own change, or, where the truth stands still, itself.
std::string measure_flicker(double flicker, const records::FlickerMotion& motion) {
  if (motion.truth.change > 0.0) return fmt::format("{:.2f} x", flicker / motion.truth.change);
  return flicker < find_least(motion) ? "rounding" : fmt::format("{:.3g}", flicker);
}

/// The yardstick: as much as a still image would flicker, or, where the truth stands still, a step of a picture.
double find_limit(const records::FlickerMotion& motion) {
  return motion.truth.change > 0.0 ? motion.truth.change : kPictureStep;
}

document::Grade grade_flicker(double flicker, const records::FlickerMotion& motion) {
  if (flicker >= find_limit(motion)) return document::Grade::kBad;
  const bool far = flicker < find_least(motion) || flicker < kFar * find_limit(motion);
  return far ? document::Grade::kGood : document::Grade::kNear;
}

constexpr std::size_t kStepsPerMark = 8;

/// A line over the steps. Only some points have a mark, so that lines of one colour are told apart.
document::ChartSeries make_change_line(const std::string& title, const std::vector<double>& changes) {
  document::ChartSeries series;
  series.title = title;
  series.line = document::LineStyle::kSolid;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    document::ChartPoint& point =
        series.points.emplace_back(document::exact_point(static_cast<double>(i + 1), changes[i]));
    point.details = {title, fmt::format("step {}: {:.4g}", i + 1, changes[i])};
  }
  return series;
}

/// Adds a filter's marks, which the key shows, and its line.
void add_filter(document::Chart& chart, const records::FlickerFilter& filter, std::size_t place) {
  const document::ChartStyle style = document::style_of(place);
  document::ChartSeries line = make_change_line(filter.filter, filter.step_change);
  line.color = style.color;
  document::ChartSeries marks = line;
  line.title.clear();
  marks.line = document::LineStyle::kNone;
  marks.mark = style.mark;
  marks.filled = false;
  marks.points.clear();
  for (std::size_t i = place % kStepsPerMark; i < line.points.size(); i += kStepsPerMark)
    marks.points.push_back(line.points[i]);
  chart.series.push_back(std::move(marks));
  chart.series.push_back(std::move(line));
}

/// A scale from 0 for everything that moves in this motion.
document::ChartAxis choose_change_axis(const records::FlickerMotion& motion) {
  std::vector<double> values = {0.0};
  values.insert(values.end(), motion.truth.step_change.begin(), motion.truth.step_change.end());
  for (const records::FlickerVariant& variant : motion.variants)
    for (const records::FlickerFilter& filter : variant.filters)
      values.insert(values.end(), filter.step_change.begin(), filter.step_change.end());
  return document::choose_axis(values, {}, document::TickKind::kNumber);
}

std::vector<std::pair<std::string, std::string>> list_flicker_facts(const records::FlickerRecord& record) {
  auto facts = list_provenance(record);
  facts.insert(
      facts.begin(),
      {{"scene", fmt::format("{}, view {}, {} x {} pixels", record.scene, record.view, record.width, record.height)},
       {"shadow map", fmt::format("{0} x {0} texels", record.map_size)},
       {"frames", fmt::format("{}", record.frames)}});
  return facts;
}

document::Section make_motion_section(const records::FlickerMotion& motion, int frames) {
  document::Section section{motion.id, fmt::format("{}: {}", motion.id, motion.title), {}};
  for (const records::FlickerVariant& variant : motion.variants)
    section.blocks.emplace_back(make_flicker_chart(motion, variant));
  section.blocks.emplace_back(document::Gallery{
      {}, {{motion.picture, "flicker by pixel, without snapping and with it; grey: less than 0.001"}}});
  section.blocks.emplace_back(document::Details{
      "All numbers, and how the motion was made",
      {document::Table{"Change and flicker: root mean squares of visibility per step", make_flicker_table(motion)},
       document::Sentences{{}, explain_motion(motion, frames)}}});
  return section;
}

}  // namespace

std::vector<std::string> define_flicker(const records::FlickerRecord& record) {
  return {
      "Receivers: the points that the first frame's pixels show, the same in all frames; those count that face the "
      "light and lie in the map, with room "
      "for every kernel, in every frame, with snapping and without.",
      "Change: root mean square, over receivers and steps, of how much visibility changes from one frame to the next; "
      "the "
      "charts show it step by step, over receivers alone.",
      "Flicker: root mean square of the change less the truth's change at the same receiver and step: change that the "
      "truth does not have, or that is missing. A still image would score the truth's own change. What is less than "
      "one receiver flipping once is called rounding.",
      fmt::format("Back and forth: share of receivers whose visibility, having gone one way, comes back by more than "
                  "{:g} within the {} frames.",
                  record.return_above, record.frames),
      "Snapping: the map's origin stays a whole number of texels from the world's, and the texel's size one of a few "
      "(Valient 2008, Stable Rendering of "
      "Cascaded Shadow Maps, ShaderX6). The measures are derived, not taken from a paper."};
}

std::vector<std::string> explain_motion(const records::FlickerMotion& motion, int frames) {
  std::vector<std::string> sentences = {
      motion.how, fmt::format("{} frames, {:.4g} {} a step, the map fitted as --fit {}; {} receivers count.", frames,
                              motion.step, motion.step_unit, motion.fit, motion.receivers)};
  for (const records::FlickerVariant& variant : motion.variants) {
    sentences.push_back(fmt::format(
        "{} snapping a step moves receivers by {:.3g} texels against the map's grid (median, whole texels left out); a "
        "texel is {:.4g} m wide, and "
        "changes its size in {} of {} steps.",
        variant.snap ? "With" : "Without", variant.grid_texels, variant.texel_m, variant.resizes, frames - 1));
  }
  for (const records::FlickerVariant& variant : motion.variants)
    for (const records::FlickerFilter& filter : variant.filters)
      if (filter.not_finite > 0)
        sentences.push_back(fmt::format("{} snapping, {} changes of {} are left out, because visibility is not finite.",
                                        variant.snap ? "With" : "Without", filter.not_finite, filter.filter));
  if (!motion.truth.moves) {
    sentences.push_back("The light stands still, and so does the truth at every receiver: all change is flicker.");
    return sentences;
  }
  sentences.push_back(
      fmt::format("The truth changes by {:.3g}, ray traced in every frame. The standard error of its changes is {:.2g} "
                  "at most (root mean square): that is what it would be if frames were "
                  "traced independently, but a pixel's random numbers are the same in all frames.",
                  motion.truth.change, motion.truth.noise));
  return sentences;
}

records::TextTable make_flicker_table(const records::FlickerMotion& motion) {
  records::TextTable table{{"filter", "change", "flicker", "back and forth", "change, snapped", "flicker, snapped",
                            "back and forth, snapped", "snapping divides flicker by"},
                           {}};
  const Filters &off = motion.variants[0].filters, &on = motion.variants[1].filters;
  const double least = find_least(motion);
  for (std::size_t i = 0; i < off.size(); ++i) {
    const std::string gain = on[i].flicker >= least    ? fmt::format("{:.2f}", off[i].flicker / on[i].flicker)
                             : off[i].flicker >= least ? "all gone"
                                                       : records::kNothing;
    table.rows.push_back({off[i].filter, fmt::format("{:.4f}", off[i].change), fmt::format("{:.4f}", off[i].flicker),
                          records::format_rate(off[i].returning), fmt::format("{:.4f}", on[i].change),
                          fmt::format("{:.4f}", on[i].flicker), records::format_rate(on[i].returning), gain});
  }
  const std::string change = fmt::format("{:.4f}", motion.truth.change),
                    returning = records::format_rate(motion.truth.returning);
  table.rows.push_back({"truth", change, fmt::format("{:.4f}", 0.0), returning, change, fmt::format("{:.4f}", 0.0),
                        returning, records::kNothing});
  return table;
}

document::Chart make_flicker_chart(const records::FlickerMotion& motion, const records::FlickerVariant& variant) {
  document::Chart chart;
  chart.id = fmt::format("flicker.{}{}", motion.id, variant.snap ? ".snapped" : "");
  chart.title = fmt::format("{}, {} snapping", motion.title, variant.snap ? "with" : "without");
  chart.x_name = "step";
  chart.y_name = "change of visibility, root mean square";
  chart.x = document::choose_axis({0.0, static_cast<double>(motion.truth.step_change.size())}, {},
                                  document::TickKind::kNumber);
  chart.y = choose_change_axis(motion);
  std::vector<std::pair<double, std::string>> weights = {{kAlways, "truth"}};
  for (std::size_t i = 0; i < variant.filters.size(); ++i) {
    add_filter(chart, variant.filters[i], i);
    const std::string& name = variant.filters[i].filter;
    weights.emplace_back(name == "none" ? kAlways : variant.filters[i].flicker, name);
  }
  document::ChartSeries truth = make_change_line("truth", motion.truth.step_change);
  truth.color = document::kInk;
  truth.line = document::LineStyle::kDashed;
  chart.series.push_back(std::move(truth));
  chart.notes.push_back("one scale without snapping and with it");
  document::show_most_telling(chart, std::move(weights));
  return chart;
}

std::string summarize_flicker(const records::FlickerMotion& motion) {
  const Filters &off = motion.variants[0].filters, &on = motion.variants[1].filters;
  const auto name = [&](const auto& filter) {
    const std::string free = measure_flicker(filter->flicker, motion),
                      snapped = measure_flicker(on[static_cast<std::size_t>(filter - off.begin())].flicker, motion);
    return fmt::format("{}, {}{}", filter->filter, free, free == snapped ? "" : " (" + snapped + " with snapping)");
  };
  const auto [least, most] = std::ranges::minmax_element(off, {}, &records::FlickerFilter::flicker);
  return fmt::format("{}: most flickers {}{}.", motion.title, name(most),
                     most->flicker > least->flicker ? "; least " + name(least) : "");
}

document::Section make_flicker_answer(const records::FlickerRecord& record) {
  document::Table table{"Flicker, without snapping and with it", {{"motion"}, {}}};
  std::vector<std::string> sentences;
  for (const records::FlickerMotion& motion : record.motions) {
    sentences.push_back(summarize_flicker(motion));
    for (const records::FlickerVariant& variant : motion.variants)
      for (const records::FlickerFilter& filter : variant.filters)
        table.judge(motion.id + (variant.snap ? ", snapped" : ""), filter.filter,
                    measure_flicker(filter.flicker, motion), grade_flicker(filter.flicker, motion));
  }
  return {"answer",
          "",
          {document::Paragraph{fmt::format("{}", fmt::join(sentences, " "))}, std::move(table),
           document::Paragraph{kFlickerNote, true}}};
}

document::Page make_flicker_page(const records::FlickerRecord& record) {
  document::Page page{"Flicker: filters in motion against the truth in motion", {make_flicker_answer(record)}, {}};
  for (const records::FlickerMotion& motion : record.motions)
    page.sections.push_back(make_motion_section(motion, record.frames));
  page.sections.push_back(
      {"data",
       "",
       {document::Details{"Settings, terms and data",
                          {document::Facts{list_flicker_facts(record)}, document::Sentences{{}, define_flicker(record)},
                           link_data({"flicker.json", "flicker.csv"})}}}});
  return page;
}

}  // namespace shadowbench::pages
