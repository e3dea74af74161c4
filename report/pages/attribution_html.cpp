#include "report/pages/attribution_html.h"

#include <fmt/format.h>

#include <cmath>

#include "report/analysis/cell_group.h"
#include "report/images/attribution_bar.h"
#include "report/images/text.h"
#include "report/page/html_parts.h"
#include "report/pages/html.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr int kBarWidth = 1000;  // units of the drawing, which is stretched to the page
constexpr int kBarHeight = 24;

std::string css_color(const images::Rgb& color) {
  const auto code = [](float value) { return std::lround(255.0f * value); };
  return fmt::format("#{:02x}{:02x}{:02x}", code(color[0]), code(color[1]), code(color[2]));
}

std::string svg_rect(const images::Rect& r, const std::string& attributes) {
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}></rect>", r.x, r.y, r.width, r.height,
                     attributes);
}

std::string svg_bar(const images::BarPlace& bar, const std::string& text) {
  std::string svg =
      fmt::format("<svg viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"{}\">", kBarWidth,
                  kBarHeight, page::escape_html(text));
  svg += svg_rect(bar.track, "class=\"track\"") + svg_rect(bar.zero_line, "class=\"zero\"");
  for (const images::SegmentBox& segment : bar.segments)
    svg +=
        svg_rect(segment.box, fmt::format("fill=\"{}\"", css_color(records::list_error_parts()[segment.part].color)));
  return svg + svg_rect(bar.net_tick, "class=\"net\"") + "</svg>";
}

std::string html_legend(const images::BarScale& scale) {
  std::string items;
  for (const records::ErrorPart& part : records::list_error_parts()) {
    items += fmt::format("<span><i style=\"background:{}\"></i>{}</span> ", css_color(part.color),
                         page::escape_html(part.name));
  }
  return fmt::format(
      "<figcaption>Where the error comes from: each part's share times RMSE. Parts left of the grey line offset the "
      "others. "
      "The black tick is the RMSE, the full width {}.<span class=\"legend\">{}</span></figcaption>\n",
      records::format_number(scale.length), items);
}

std::string html_bar(const analysis::CellGroup& group, const records::CellRecord& cell, const images::BarScale& scale) {
  const std::string name = analysis::label_cell(group, cell);
  const std::string head =
      fmt::format("<li><span><b>{}</b> RMSE {}", page::escape_html(name), records::format_number(*cell.error.rmse));
  const auto bar = images::make_attribution_bar(cell);
  if (!bar)
    return fmt::format("{} · no attribution: {}</span></li>\n", head,
                       page::escape_html(records::explain_no_attribution(cell)));
  const std::string shares = records::describe_shares(*records::list_shares(cell));
  return fmt::format("{} · {}</span>{}</li>\n", head, page::escape_html(shares),
                     svg_bar(images::place_bar(*bar, scale, {0, 0, kBarWidth, kBarHeight}, 0), name + ": " + shares));
}

}  // namespace

std::string make_bars_html(const analysis::CellGroup& group) {
  std::vector<images::AttributionBar> bars;
  for (const records::CellRecord& cell : group.cells)
    if (const auto bar = images::make_attribution_bar(cell)) bars.push_back(*bar);
  if (bars.empty()) return {};
  const images::BarScale scale = images::choose_bar_scale(bars);
  std::string text = "<figure class=\"bars\">\n" + html_legend(scale) + "<ul>\n";
  for (const records::CellRecord& cell : group.cells)
    if (cell.error.rmse) text += html_bar(group, cell, scale);
  return text + "</ul>\n</figure>\n";
}

}  // namespace shadowbench::pages
