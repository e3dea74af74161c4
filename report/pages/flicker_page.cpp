#include "report/pages/flicker_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/page/chart_style.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr double kSame = 0.05;  // a smaller relative difference is called none

using Filters = std::vector<records::FlickerFilter>;

/// What flickers less than this, which is one receiver that flips once, is called rounding.
double find_least(const records::FlickerMotion& motion) {
  return 1.0 / std::sqrt(static_cast<double>(motion.receivers) *
                         static_cast<double>(std::max<std::size_t>(1, motion.truth.step_change.size())));
}

bool by_flicker(const records::FlickerFilter& a, const records::FlickerFilter& b) { return a.flicker < b.flicker; }

std::string against_truth(double value, const records::FlickerTruth& truth) {
  return truth.change > 0.0 ? fmt::format(", {:.2f} times the truth's own change", value / truth.change)
                            : std::string();
}

std::string when(const records::FlickerVariant& variant) { return variant.snap ? "With snapping" : "Without snapping"; }

std::string describe_extremes(const records::FlickerVariant& variant, const records::FlickerMotion& motion) {
  const auto [least, most] = std::ranges::minmax_element(variant.filters, by_flicker);
  if (most->flicker < find_least(motion))
    return fmt::format("{} nothing flickers as much as one receiver that flips once: {:.2g} at most ({}).",
                       when(variant), most->flicker, most->filter);
  std::string text = fmt::format("{} {} flickers most, {:.3g}{}", when(variant), most->filter, most->flicker,
                                 against_truth(most->flicker, motion.truth));
  if (most->filter == least->filter) return text + ".";
  return text + fmt::format("; {} least, {:.3g}{}.", least->filter, least->flicker,
                            against_truth(least->flicker, motion.truth));
}

/// Which filters change more than the truth, and which less. A shadow that is too soft changes less.
std::string describe_changes(const records::FlickerVariant& variant, const records::FlickerTruth& truth) {
  const auto [least, most] = std::ranges::minmax_element(variant.filters, {}, &records::FlickerFilter::change);
  std::vector<std::string> less;
  for (const records::FlickerFilter& filter : variant.filters)
    if (filter.change < truth.change) less.push_back(filter.filter);
  return fmt::format("{} visibility changes {:.2f} ({}) to {:.2f} times ({}) as much as the truth's{}.", when(variant),
                     least->change / truth.change, least->filter, most->change / truth.change, most->filter,
                     less.empty() ? std::string() : fmt::format("; less than the truth's: {}", fmt::join(less, ", ")));
}

/// The ratio of a filter's flicker without snapping to its flicker with it.
struct Gain {
  std::string filter;
  double ratio = 1.0;
};

std::string describe_range(std::vector<Gain> gains, const char* does) {
  std::ranges::sort(gains, {}, &Gain::ratio);
  const auto name = [](const Gain& gain) { return fmt::format("{:.2f} ({})", gain.ratio, gain.filter); };
  if (gains.size() == 1) return fmt::format("{} {}", does, name(gains.front()));
  return fmt::format("{} {} to {}", does, name(gains.front()), name(gains.back()));
}

std::string describe_snapping(const Filters& off, const Filters& on, double least) {
  std::vector<std::string> gone, same;
  std::vector<Gain> better, worse;
  for (std::size_t i = 0; i < off.size(); ++i) {
    const double a = off[i].flicker, b = on[i].flicker;
    if (a < least && b < least) continue;
    if (a >= least && b < least)
      gone.push_back(off[i].filter);
    else if (std::abs(a - b) <= kSame * std::max(a, b))
      same.push_back(off[i].filter);
    else if (a > b)
      better.push_back({off[i].filter, a / b});
    else
      worse.push_back({off[i].filter, b / std::max(a, least)});
  }
  std::vector<std::string> parts;
  if (!gone.empty())
    parts.push_back(gone.size() == off.size()
                        ? "takes away all flicker but rounding of every filter"
                        : fmt::format("takes away all flicker but rounding of {}", fmt::join(gone, ", ")));
  if (!better.empty()) parts.push_back(describe_range(better, "divides flicker by"));
  if (!worse.empty()) parts.push_back(describe_range(worse, "multiplies flicker by"));
  if (!same.empty())
    parts.push_back(
        fmt::format("leaves it as it is, within {:g} %, {}", 100.0 * kSame,
                    same.size() == off.size() ? "of every filter" : fmt::format("of {}", fmt::join(same, ", "))));
  return parts.empty() ? "Snapping changes nothing: nothing flickers."
                       : fmt::format("Snapping {}.", fmt::join(parts, "; "));
}

std::string describe_returning(const records::FlickerVariant& variant, const records::FlickerTruth& truth) {
  const auto most = std::ranges::max_element(variant.filters, {}, &records::FlickerFilter::returning);
  if (most->returning == 0.0) return when(variant) + " no filter's visibility goes back and forth.";
  return fmt::format("{} the visibility of {} goes back and forth at the most receivers, {}; the truth's at {}.",
                     when(variant), most->filter, records::format_rate(most->returning),
                     records::format_rate(truth.returning));
}

std::string describe_not_finite(const records::FlickerVariant& variant) {
  std::vector<std::string> named;
  for (const records::FlickerFilter& filter : variant.filters)
    if (filter.not_finite > 0) named.push_back(fmt::format("{} ({})", filter.filter, filter.not_finite));
  if (named.empty()) return {};
  return fmt::format("{} snapping, changes left out because visibility is not finite there: {}.",
                     variant.snap ? "With" : "Without", fmt::join(named, ", "));
}

constexpr std::size_t kStepsPerMark = 8;

/// A line over the steps. Only some points have a mark, so that lines of one colour are told apart.
page::ChartSeries make_change_line(const std::string& title, const std::vector<double>& changes) {
  page::ChartSeries series;
  series.title = title;
  series.line = page::LineStyle::kSolid;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    page::ChartPoint& point = series.points.emplace_back(page::exact_point(static_cast<double>(i + 1), changes[i]));
    point.details = {title, fmt::format("step {}: {:.4g}", i + 1, changes[i])};
  }
  return series;
}

/// Adds a filter's marks, which the key shows, and its line.
void add_filter(page::Chart& chart, const records::FlickerFilter& filter, std::size_t place) {
  const page::ChartStyle style = page::style_of(place);
  page::ChartSeries line = make_change_line(filter.filter, filter.step_change);
  line.color = style.color;
  page::ChartSeries marks = line;
  line.title.clear();
  marks.line = page::LineStyle::kNone;
  marks.mark = style.mark;
  marks.filled = false;
  marks.points.clear();
  for (std::size_t i = place % kStepsPerMark; i < line.points.size(); i += kStepsPerMark)
    marks.points.push_back(line.points[i]);
  chart.series.push_back(std::move(marks));
  chart.series.push_back(std::move(line));
}

/// A scale from 0 for everything that moves in this motion.
page::ChartAxis choose_change_axis(const records::FlickerMotion& motion) {
  std::vector<double> values = {0.0};
  values.insert(values.end(), motion.truth.step_change.begin(), motion.truth.step_change.end());
  for (const records::FlickerVariant& variant : motion.variants)
    for (const records::FlickerFilter& filter : variant.filters)
      values.insert(values.end(), filter.step_change.begin(), filter.step_change.end());
  return page::choose_axis(values, {}, page::TickKind::kNumber);
}

std::vector<std::pair<std::string, std::string>> list_flicker_facts(const records::FlickerRecord& record) {
  return {{"scene", fmt::format("{}, view {}, {} x {} pixels", record.scene, record.view, record.width, record.height)},
          {"shadow map", fmt::format("{0} x {0} texels", record.map_size)},
          {"frames", fmt::format("{}", record.frames)},
          {"OpenGL", fmt::format("{} ({}), {}", record.gl.renderer, record.gl.backend, record.gl.version)},
          {"program", record.commit},
          {"command", fmt::format("{}", fmt::join(record.command, " "))},
          {"took", fmt::format("{:.1f} s", record.seconds)}};
}

page::Section make_motion_section(const records::FlickerMotion& motion, int frames) {
  page::Section section{motion.id, fmt::format("{}: {}", motion.id, motion.title), {}};
  section.blocks = {
      page::Sentences{{}, describe_flicker(motion)},
      page::Table{"Change and flicker: root mean squares of visibility per step", make_flicker_table(motion)},
      page::Sentences{{}, explain_motion(motion, frames)}};
  for (const records::FlickerVariant& variant : motion.variants)
    section.blocks.emplace_back(make_flicker_chart(motion, variant));
  section.blocks.emplace_back(
      page::Gallery{{}, {{motion.picture, "flicker by pixel, without snapping and with it; grey: less than 0.001"}}});
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

std::vector<std::string> describe_flicker(const records::FlickerMotion& motion) {
  std::vector<std::string> sentences;
  for (const records::FlickerVariant& variant : motion.variants)
    sentences.push_back(describe_extremes(variant, motion));
  if (motion.truth.change > 0.0)
    for (const records::FlickerVariant& variant : motion.variants)
      sentences.push_back(describe_changes(variant, motion.truth));
  sentences.push_back(describe_snapping(motion.variants[0].filters, motion.variants[1].filters, find_least(motion)));
  for (const records::FlickerVariant& variant : motion.variants)
    sentences.push_back(describe_returning(variant, motion.truth));
  for (const records::FlickerVariant& variant : motion.variants)
    if (std::string left_out = describe_not_finite(variant); !left_out.empty())
      sentences.push_back(std::move(left_out));
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

page::Chart make_flicker_chart(const records::FlickerMotion& motion, const records::FlickerVariant& variant) {
  page::Chart chart;
  chart.id = fmt::format("flicker.{}{}", motion.id, variant.snap ? ".snapped" : "");
  chart.title = fmt::format("{}, {} snapping", motion.title, variant.snap ? "with" : "without");
  chart.x_name = "step";
  chart.y_name = "change of visibility, root mean square";
  chart.x = page::choose_axis({0.0, static_cast<double>(motion.truth.step_change.size())}, {}, page::TickKind::kNumber);
  chart.y = choose_change_axis(motion);
  for (std::size_t i = 0; i < variant.filters.size(); ++i) add_filter(chart, variant.filters[i], i);
  page::ChartSeries truth = make_change_line("truth", motion.truth.step_change);
  truth.color = page::kInk;
  truth.line = page::LineStyle::kDashed;
  chart.series.push_back(std::move(truth));
  chart.notes.push_back("one scale without snapping and with it");
  return chart;
}

page::Page make_flicker_page(const records::FlickerRecord& record) {
  page::Page page{"Flicker: filters in motion against the truth in motion", {}, {}};
  page.sections.push_back(
      {{}, {}, {page::Facts{list_flicker_facts(record)}, page::Sentences{{}, define_flicker(record)}}});
  for (const records::FlickerMotion& motion : record.motions)
    page.sections.push_back(make_motion_section(motion, record.frames));
  page.sections.push_back({"data", "", {link_data({"flicker.json", "flicker.csv"})}});
  return page;
}

}  // namespace shadowbench::pages
