#include "report/images/figures/heat_panels.h"

#include <algorithm>
#include <cassert>

#include "report/images/color_values.h"
#include "report/images/figures/figure.h"
#include "report/records/format.h"

namespace shadowbench::images {
namespace {

constexpr int kHeatPanelGap = 40;
constexpr int kColorBarHeight = 16;

std::vector<std::string> list_lines(const HeatPanel& panel) {
  std::vector<std::string> lines = wrap_figure_text(panel.title, kHeatPanelWidth);
  for (const std::string& line : wrap_figure_text(panel.caption, kHeatPanelWidth)) lines.push_back(line);
  return lines;
}

int measure_height(const HeatPanel& panel) {
  const int line = figure_line_height();
  return static_cast<int>(list_lines(panel).size()) * line + panel.picture.height + kColorBarHeight + 3 * line;
}

void draw_heat_panel(Figure& figure, int x, int y, const HeatPanel& panel) {
  const int line = figure_line_height();
  const std::size_t of_title = wrap_figure_text(panel.title, kHeatPanelWidth).size();
  std::size_t number = 0;
  for (const std::string& text : list_lines(panel)) {
    figure.write(x, y, text, number++ < of_title ? kFigureInk : kFigureSecondInk);
    y += line;
  }
  y += line / 4;
  figure.place(x, y, panel.picture);
  y += panel.picture.height + line / 2;
  figure.place(x, y, panel.bar);
  for (const auto& [place, label] : panel.ticks) {
    const int at = x + static_cast<int>(place * static_cast<float>(kHeatPanelWidth - 1));
    figure.fill({at, y + kColorBarHeight, 1, 5}, kFigureSecondInk);
    if (place <= 0.0f)
      figure.write(x, y + kColorBarHeight + 6, label);
    else if (place >= 1.0f)
      figure.write_before(at, y + kColorBarHeight + 6, label);
    else
      figure.write_centred(at, y + kColorBarHeight + 6, label);
  }
}

}  // namespace

Image fit_heat_panel(const Image& image, const Badness& badness) {
  const int width = image.width >= kHeatPanelWidth ? kHeatPanelWidth : image.width * (kHeatPanelWidth / image.width);
  return fit_worst(image, width, badness);
}

Image make_color_bar() { return make_ramp(kHeatPanelWidth, kColorBarHeight); }

std::vector<Tick> list_signed_ticks(double scale) {
  std::vector<Tick> ticks;
  for (const double part : {-1.0, -0.5, 0.0, 0.5, 1.0})
    ticks.emplace_back(static_cast<float>(0.5 + 0.5 * part), records::format_number(part * scale));
  return ticks;
}

Image draw_heat_panels(const std::string& title, const std::string& note, const std::vector<HeatPanel>& panels) {
  assert(!panels.empty());
  const int columns = std::min<int>(2, static_cast<int>(panels.size()));
  std::vector<int> row_heights((panels.size() + 1) / 2, 0);
  for (std::size_t i = 0; i < panels.size(); ++i)
    row_heights[i / 2] = std::max(row_heights[i / 2], measure_height(panels[i]));
  int height = 0;
  for (const int row : row_heights) height += row;
  Figure figure(title, note, {columns * kHeatPanelWidth + (columns - 1) * kHeatPanelGap, height});
  int y = figure.body().y;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    draw_heat_panel(figure, figure.body().x + static_cast<int>(i % 2) * (kHeatPanelWidth + kHeatPanelGap), y,
                    panels[i]);
    if (i % 2 == 1) y += row_heights[i / 2];
  }
  return figure.canvas();
}

}  // namespace shadowbench::images
