#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/images/text.h"
#include "report/page/gnuplot.h"
#include "report/page/plot_style.h"

namespace shadowbench::page {
namespace {

constexpr int kWidth = 1120, kHeight = 620;

// In single quotes gnuplot takes everything as it is, on one line; a quote inside becomes a typographic one, because
// gnuplot misreads a doubled quote at the beginning.
std::string quote(const std::string& text) {
  std::string quoted = "'";
  for (const char c : images::clean_text(text)) quoted += c == '\'' ? "’" : std::string(1, c);
  return quoted + "'";
}

std::string format_axis(char name, const std::string& title, const PlotAxis& axis) {
  std::vector<std::string> ticks;
  for (const auto& [value, label] : axis.ticks) ticks.push_back(fmt::format("{} {}", quote(label), value));
  return fmt::format("{3}set logscale {0}\nset {0}label {1} noenhanced\nset {0}range [{4}:{5}]\nset {0}tics ({2})\n",
                     name, quote(title), fmt::join(ticks, ", "), axis.log ? "" : "un", axis.low, axis.high);
}

// Interval ends outside an axis would be dropped with their point.
double clamp_to(const PlotAxis& axis, double value) { return std::clamp(value, axis.low, axis.high); }

std::string format_block(const std::string& name, const PlotSeries& series, const Plot& plot) {
  std::string text = name + " << EOD\n";
  for (const PlotPoint& p : series.points) {
    text += fmt::format("{} {} {} {} {} {}\n", p.x.value, p.y.value, clamp_to(plot.x, p.x.low),
                        clamp_to(plot.x, p.x.high), clamp_to(plot.y, p.y.low), clamp_to(plot.y, p.y.high));
  }
  return text + "EOD\n";
}

std::string format_labels(const PlotSeries& series) {
  std::string text;
  for (const PlotPoint& p : series.points) {
    if (p.label.empty()) continue;
    text += fmt::format(
        "set label {} at first {}, first {} right offset character -0.9, -0.75 noenhanced front textcolor rgb '{}'\n",
        quote(p.label), p.x.value, p.y.value, kInk);
  }
  return text;
}

std::string format_title(const PlotSeries& series) {
  return series.title.empty() ? "notitle" : fmt::format("title {} noenhanced", quote(series.title));
}

// What one series adds to the plot command: whiskers below, then the line, then points; the key has one of them.
std::vector<std::string> format_series(const std::string& block, const PlotSeries& series) {
  std::vector<std::string> parts;
  if (series.points.empty()) {
    if (series.title.empty()) return parts;
    return {fmt::format("keyentry with points pointtype {} pointsize 1.1 linecolor rgb '{}' {}", series.point_type,
                        series.color, format_title(series))};
  }
  if (series.whiskers) {
    parts.push_back(
        fmt::format("{} using 1:2:3:4:5:6 with xyerrorbars pointtype 0 linewidth 1 linecolor rgb '{}' notitle", block,
                    series.color));
  }
  if (series.line != PlotLine::kNone) {
    parts.push_back(fmt::format("{} using 1:2 with {} linewidth 1.6 dashtype {} linecolor rgb '{}' {}", block,
                                series.line == PlotLine::kSteps ? "steps" : "lines",
                                series.line == PlotLine::kDashed ? 2 : 1, series.color,
                                series.point_type == 0 ? format_title(series) : "notitle"));
  }
  if (series.point_type != 0) {
    parts.push_back(
        fmt::format("{} using 1:2 with points pointtype {} pointsize 1.1 linewidth 1.4 linecolor rgb '{}' {}", block,
                    series.point_type, series.color, format_title(series)));
  }
  return parts;
}

std::string format_plot(const Plot& plot) {
  std::string text =
      fmt::format("\nset output {}\nset title {} noenhanced\nunset label\n", quote(plot.file), quote(plot.title));
  text += format_axis('x', plot.x_name, plot.x) + format_axis('y', plot.y_name, plot.y);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const std::string block = fmt::format("$series{}", i);
    if (!plot.series[i].points.empty())
      text += format_block(block, plot.series[i], plot) + format_labels(plot.series[i]);
    const auto more = format_series(block, plot.series[i]);
    parts.insert(parts.end(), more.begin(), more.end());
  }
  for (const std::string& note : plot.notes) {
    parts.push_back(
        fmt::format("keyentry with points pointtype 0 linecolor rgb 'white' title {} noenhanced", quote(note)));
  }
  return text + fmt::format("plot {}\nunset output\n", fmt::join(parts, ", \\\n     "));
}

}  // namespace

std::string make_gnuplot_script(const std::vector<Plot>& plots) {
  std::string text = fmt::format(
      "# Run in the report folder: gnuplot FILE\n"
      "set encoding utf8\n"
      "set terminal svg size {},{} noenhanced font 'DejaVu Sans,13' background rgb 'white'\n"
      "set border 3 linecolor rgb '{}'\nset tics nomirror out textcolor rgb '{}'\nunset mxtics\nunset mytics\n"
      "set grid xtics ytics back linetype 1 linecolor rgb '#e2e4e8' linewidth 0.7\n"
      "set key outside right top vertical Left reverse spacing 1.15 samplen 2\nset bars 0.5\n",
      kWidth, kHeight, kInk, kInk);
  for (const Plot& plot : plots) text += format_plot(plot);
  return text;
}

}  // namespace shadowbench::page
