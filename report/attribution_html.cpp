#include "report/attribution_html.h"

#include <fmt/format.h>

#include <cmath>

#include "report/attribution_bar.h"
#include "report/html.h"

namespace shadowbench::report {
namespace {

constexpr int kBarWidth = 1000;  // units of the drawing, which is stretched to the page
constexpr int kBarHeight = 24;

std::string css_color(const Rgb& color) {
  const auto code = [](float value) { return std::lround(255.0f * value); };
  return fmt::format("#{:02x}{:02x}{:02x}", code(color[0]), code(color[1]), code(color[2]));
}

std::string svg_rect(const Rect& r, const std::string& attributes) {
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}></rect>", r.x, r.y, r.width, r.height,
                     attributes);
}

std::string svg_bar(const BarPlace& bar, const std::string& text) {
  std::string svg =
      fmt::format("<svg viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{}\">", kBarWidth,
                  kBarHeight, escape_html(text));
  svg += svg_rect(bar.track, "class=\"track\"") + svg_rect(bar.zero_line, "class=\"zero\"");
  for (const SegmentBox& segment : bar.segments)
    svg += svg_rect(segment.box, fmt::format("fill=\"{}\"", css_color(list_error_parts()[segment.part].color)));
  return svg + svg_rect(bar.net_tick, "class=\"net\"") + "</svg>";
}

std::string html_legend(const BarScale& scale) {
  std::string items;
  for (const ErrorPart& part : list_error_parts()) {
    items +=
        fmt::format("<span><i style=\"background:{}\"></i>{}</span> ", css_color(part.color), escape_html(part.name));
  }
  return fmt::format(
      "<figcaption>Where the error comes from: each part's share times RMSE. Parts left of the grey line offset the "
      "others. "
      "The black tick is the RMSE, the full width {}.<span class=\"legend\">{}</span></figcaption>\n",
      format_number(scale.length), items);
}

std::string html_bar(const CellGroup& group, const CellRecord& cell, const BarScale& scale) {
  const std::string name = label_cell(group, cell);
  const std::string head =
      fmt::format("<li><span><b>{}</b> RMSE {}", escape_html(name), format_number(*cell.error.rmse));
  const auto bar = make_attribution_bar(cell);
  if (!bar)
    return fmt::format("{} · no attribution: {}</span></li>\n", head, escape_html(explain_no_attribution(cell)));
  const std::string shares = describe_shares(*list_shares(cell));
  return fmt::format("{} · {}</span>{}</li>\n", head, escape_html(shares),
                     svg_bar(place_bar(*bar, scale, {0, 0, kBarWidth, kBarHeight}, 0), name + ": " + shares));
}

}  // namespace

std::string make_bars_html(const CellGroup& group) {
  std::vector<AttributionBar> bars;
  for (const CellRecord& cell : group.cells)
    if (const auto bar = make_attribution_bar(cell)) bars.push_back(*bar);
  if (bars.empty()) return {};
  const BarScale scale = choose_bar_scale(bars);
  std::string text = "<figure class=\"bars\">\n" + html_legend(scale) + "<ul>\n";
  for (const CellRecord& cell : group.cells)
    if (cell.error.rmse) text += html_bar(group, cell, scale);
  return text + "</ul>\n</figure>\n";
}

}  // namespace shadowbench::report
