#include "report/pages/stress_plots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/page/plot_style.h"

namespace shadowbench::pages {
namespace {

constexpr std::size_t kLimitsPerLine = 5;
constexpr double kLeastShown = 1e-9;  // of a logarithmic scale

/// A place in the plot, without intervals.
page::PlotPoint place(double x, double y) { return {{x, x, x}, {y, y, y}}; }

bool is_shown(const records::StressAxis& axis, const std::optional<double>& measured) {
  return measured && (!axis.measured_log || *measured >= kLeastShown);
}

std::vector<double> list_measured(const records::StressAxis& axis) {
  std::vector<double> values = {axis.bound};
  for (const records::StressCase& item : axis.cases) {
    for (const records::StressSample& sample : item.samples)
      if (is_shown(axis, sample.measured)) values.push_back(*sample.measured);
  }
  return values;
}

page::PlotAxis choose_value_axis(const records::StressAxis& axis) {
  const std::vector<double> ends = {axis.range.low, axis.range.high};
  if (axis.log) return page::choose_log_axis(ends, {});
  page::PlotAxis chosen = page::choose_axis(ends, {}, page::TickKind::kNumber);
  if (chosen.log)
    chosen = page::choose_axis({0.0, axis.range.high}, {},
                               page::TickKind::kNumber);  // it prefers a logarithm for what is positive
  return chosen;
}

page::PlotAxis choose_measured_axis(const records::StressAxis& axis) {
  const std::vector<double> values = list_measured(axis);
  return axis.measured_log ? page::choose_log_axis(values, {}) : page::choose_axis(values, {}, page::TickKind::kNumber);
}

/// What is drawn alike: the levels of one variant.
std::string group_of(const records::StressCase& item) { return item.filter + ": " + item.variant; }

void add_case(page::Plot& plot, const records::StressAxis& axis, const records::StressCase& item,
              const page::PlotStyle& style) {
  const bool model = item.level == "model";  // beside the GL's line, whose points would hide it
  page::PlotSeries line{records::label_of(item),
                        style.color,
                        model ? 0 : style.hollow_point,
                        model ? page::PlotLine::kDashed : page::PlotLine::kSolid,
                        false,
                        {}};
  page::PlotSeries broken{{}, style.color, style.filled_point, page::PlotLine::kNone, false, {}};
  for (const records::StressSample& sample : item.samples) {
    const bool shown = is_shown(axis, sample.measured);
    if (shown) line.points.push_back(place(sample.value, *sample.measured));
    if (sample.verdict == records::StressVerdict::kBroken)
      broken.points.push_back(place(sample.value, shown ? *sample.measured : plot.y.high));
  }
  plot.series.push_back(std::move(line));
  if (!broken.points.empty()) plot.series.push_back(std::move(broken));
}

/// Vertical lines, one for each theoretical limit within the plot.
void add_theory(page::Plot& plot, const records::StressAxis& axis) {
  std::map<std::string, double> onsets;  // by what the label says, so that equal limits are one line
  for (const records::StressCase& item : axis.cases) {
    for (const records::StressLimit& limit : item.limits)
      if (limit.onset && *limit.onset >= plot.x.low && *limit.onset <= plot.x.high)
        onsets.emplace(fmt::format("{:.4g}", *limit.onset), *limit.onset);
  }
  std::vector<std::pair<double, std::string>> sorted;
  for (const auto& [label, onset] : onsets) sorted.emplace_back(onset, label);
  std::ranges::sort(sorted);
  std::string title = "theoretical limits:";
  for (const auto& [onset, label] : sorted) {
    plot.series.push_back(
        {title, page::kInk, 0, page::PlotLine::kDashed, false, {place(onset, plot.y.low), place(onset, plot.y.high)}});
    title.clear();
  }
  for (std::size_t i = 0; i < sorted.size(); i += kLimitsPerLine) {
    std::vector<std::string> labels;
    for (std::size_t j = i; j < std::min(i + kLimitsPerLine, sorted.size()); ++j) labels.push_back(sorted[j].second);
    plot.notes.push_back(fmt::format("{}", fmt::join(labels, ", ")));
  }
  const bool says_none = std::ranges::any_of(axis.cases, [](const records::StressCase& item) {
    return std::ranges::any_of(item.limits, [](const records::StressLimit& limit) { return !limit.onset; });
  });
  if (says_none) plot.notes.push_back("some cases have no theoretical limit");
}

}  // namespace

std::string plot_file(const records::StressAxis& axis) { return fmt::format("stress.{}.svg", axis.id); }

bool has_plot(const records::StressAxis& axis) {
  return std::ranges::any_of(
      axis.cases, [](const records::StressCase& item) { return !item.samples.empty(); });
}

page::Plot make_stress_plot(const records::StressAxis& axis) {
  const auto with_unit = [](const std::string& name, const std::string& unit) {
    return unit.empty() ? name : fmt::format("{}, {}", name, unit);
  };
  page::Plot plot;
  plot.file = plot_file(axis);
  plot.title = axis.title;
  plot.x_name = with_unit(axis.quantity, axis.unit);
  plot.y_name = with_unit(axis.measured, axis.measured_unit);
  plot.x = choose_value_axis(axis);
  plot.y = choose_measured_axis(axis);
  std::map<std::string, std::size_t> styles;
  for (const records::StressCase& item : axis.cases)
    if (!item.samples.empty())
      add_case(plot, axis, item, page::style_of(styles.emplace(group_of(item), styles.size()).first->second));
  plot.series.push_back({fmt::format("bound, {:g}", axis.bound),
                         "#8a8f98",
                         0,
                         page::PlotLine::kDashed,
                         false,
                         {place(plot.x.low, axis.bound), place(plot.x.high, axis.bound)}});
  add_theory(plot, axis);
  plot.notes.push_back("filled: broken");
  return plot;
}

}  // namespace shadowbench::pages
