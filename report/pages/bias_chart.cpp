#include "report/pages/bias_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include "report/page/html_parts.h"

namespace shadowbench::pages {
namespace {

// Units of the view box. The longest label beside the axis is "100 %".
constexpr double kWidth = 480, kHeight = 300;
constexpr double kLeft = 62, kRight = 466, kTop = 26, kBottom = 250;
constexpr double kInset = 14;  // from the axis to the first and last factor
constexpr double kRates[] = {0.0, 0.01, 0.05, 0.1, 0.25, 0.5, 1.0};
constexpr std::size_t kColors = 10, kMarks = 3;

using Rate = std::optional<double> records::BiasPoint::*;

std::string text(ChartPoint at, std::string_view anchor, std::string_view content, std::string_view more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", at.x, at.y, anchor, more,
                     page::escape_html(content));
}

std::string line(ChartPoint a, ChartPoint b, std::string_view style) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"></line>", style, a.x,
                     a.y, b.x, b.y);
}

/// A circle, a square or a diamond.
std::string mark(ChartPoint at, std::size_t filter) {
  if (filter % kMarks == 0)
    return fmt::format("<circle class=\"point\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"></circle>", at.x, at.y);
  const double half = filter % kMarks == 1 ? 2.6 : 2.9;
  const std::string turn =
      filter % kMarks == 1 ? "" : fmt::format(" transform=\"rotate(45 {:.1f} {:.1f})\"", at.x, at.y);
  return fmt::format("<rect class=\"point\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"{}></rect>",
                     at.x - half, at.y - half, 2.0 * half, 2.0 * half, turn);
}

std::string axes(const std::vector<double>& factors) {
  std::string svg;
  for (const double rate : kRates) {
    const double y = place_in_chart(factors, factors.front(), rate).y;
    svg += line({kLeft, y}, {kRight, y}, "grid");
    svg += text({kLeft - 6, y + 4}, "end", fmt::format("{} %", 100.0 * rate), " class=\"axis\"");
  }
  for (const double factor : factors) {
    svg +=
        text({place_in_chart(factors, factor, 0.0).x, kBottom + 18}, "middle", name_factor(factor), " class=\"axis\"");
  }
  svg += text({0.5 * (kLeft + kRight), kBottom + 40}, "middle", "amount / theoretical amount");
  const double middle = 0.5 * (kTop + kBottom);
  return svg + text({12, middle}, "middle", "rate (square-root scale)",
                    fmt::format(" transform=\"rotate(-90 12 {:.1f})\"", middle));
}

std::string theory_line(const std::vector<double>& factors) {
  if (!std::count(factors.begin(), factors.end(), 1.0)) return {};
  const double x = place_in_chart(factors, 1.0, 0.0).x;
  return line({x, kTop - 8}, {x, kBottom}, "theory") + text({x, kTop - 12}, "middle", "theory");
}

std::string draw_curve(const records::BiasCurve& curve, Rate rate, const std::vector<double>& factors,
                       std::size_t filter) {
  std::string points, marks;
  for (const records::BiasPoint& point : curve.points) {
    if (!point.factor || !(point.*rate)) continue;
    const ChartPoint at = place_in_chart(factors, *point.factor, *(point.*rate));
    points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", at.x, at.y);
    marks += mark(at, filter);
  }
  if (points.empty()) return {};
  const bool gap = rate == &records::BiasPoint::contact_gap;
  return fmt::format(
      "<g class=\"c{}\"><title>{}: {}</title><polyline class=\"curve{}\" points=\"{}\"></polyline>{}</g>",
      filter % kColors, page::escape_html(curve.filter), gap ? "contact gap" : "acne", gap ? " gap" : "", points,
      marks);
}

std::string draw_curves(const records::BiasModeRecord& mode, const std::vector<std::string>& filters, Rate rate,
                        const std::vector<double>& factors) {
  std::string svg;
  for (const records::BiasCurve& curve : mode.curves) {
    const auto place = std::find(filters.begin(), filters.end(), curve.filter);
    svg += draw_curve(curve, rate, factors, static_cast<std::size_t>(place - filters.begin()));
  }
  return svg;
}

}  // namespace

ChartPoint place_in_chart(const std::vector<double>& factors, double factor, double rate) {
  const auto place = std::find(factors.begin(), factors.end(), factor);
  assert(place != factors.end());
  const double steps = std::max(1.0, static_cast<double>(factors.size()) - 1.0);
  const double along = static_cast<double>(place - factors.begin()) / steps;
  return {kLeft + kInset + along * (kRight - kLeft - 2.0 * kInset), kBottom - std::sqrt(rate) * (kBottom - kTop)};
}

std::vector<double> list_factors(const records::BiasModeRecord& mode) {
  std::set<double> factors;
  for (const records::BiasCurve& curve : mode.curves) {
    for (const records::BiasPoint& point : curve.points)
      if (point.factor) factors.insert(*point.factor);
  }
  return {factors.begin(), factors.end()};
}

std::string name_factor(double factor) {
  return factor > 0.0 && factor < 1.0 ? fmt::format("1/{:.4g}", 1.0 / factor) : fmt::format("{:.4g}", factor);
}

std::string make_bias_chart(const records::BiasModeRecord& mode, const std::vector<std::string>& filters) {
  const std::vector<double> factors = list_factors(mode);
  if (factors.empty()) return {};
  const std::string acne = draw_curves(mode, filters, &records::BiasPoint::acne, factors);
  const std::string gap = draw_curves(mode, filters, &records::BiasPoint::contact_gap, factors);
  std::string svg = fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                                kHeight, page::escape_html(mode.mode + ": acne and contact gap over the amount"));
  svg += axes(factors) + theory_line(factors) + gap + acne;
  const auto say_absent = [&](const std::string& drawn, double y, std::string_view what) {
    if (drawn.empty()) svg += text({kRight - 4, y}, "end", what);
  };
  say_absent(acne, kTop + 16, "acne: absent");
  say_absent(gap, kTop + 32, "contact gap: absent");
  return svg + "</svg>";
}

std::string make_bias_legend(const records::BiasModeRecord& mode, const std::vector<std::string>& filters) {
  std::string html = "<p class=\"legend\">";
  for (std::size_t i = 0; i < filters.size(); ++i) {
    const auto is_it = [&](const records::BiasCurve& curve) { return curve.filter == filters[i]; };
    if (std::none_of(mode.curves.begin(), mode.curves.end(), is_it)) continue;
    html += fmt::format(
        "<span><svg class=\"c{}\" viewBox=\"0 0 32 16\" aria-hidden=\"true\"><path class=\"curve\" d=\"M1 "
        "8H31\"></path>{}</svg>{}</span> ",
        i % kColors, mark({16, 8}, i), page::escape_html(filters[i]));
  }
  html +=
      "<span><svg viewBox=\"0 0 32 16\" aria-hidden=\"true\"><path class=\"curve\" d=\"M1 "
      "8H31\"></path></svg>acne</span> ";
  return html +
         "<span><svg viewBox=\"0 0 32 16\" aria-hidden=\"true\"><path class=\"curve gap\" d=\"M1 "
         "8H31\"></path></svg>contact gap</span></p>\n";
}

}  // namespace shadowbench::pages
