#include "report/pages/trade_section.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/analysis/front_words.h"
#include "report/analysis/growth.h"
#include "report/page/embedded.h"
#include "report/page/html_parts.h"
#include "report/page/markdown.h"
#include "report/pages/html.h"
#include "report/pages/tables.h"
#include "report/pages/trade_data.h"
#include "report/pages/trade_plots.h"
#include "report/pages/trade_table.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

std::string html_select(const std::string& id, const std::string& label) {
  return fmt::format("<label>{} <select id=\"{}\"></select></label>\n", page::escape_html(label), id);
}

// Drawn by trade_page.js.
std::string html_plot(const std::string& name, const std::string& description, const std::string& selects) {
  return fmt::format(
      "<div class=\"trade-controls\">{2}<button id=\"{0}-save\" type=\"button\">Save as PNG</button></div>\n"
      "<div class=\"trade-canvas\"><canvas id=\"{0}-canvas\" role=\"img\" aria-label=\"{1}\"></canvas></div>\n",
      name, page::escape_html(description), selects);
}

// RMSE against both times: what is said without scripts, and in summary.md.
std::vector<std::string> describe_scope(const analysis::TradeScope& scope, const records::GlRecord& gl) {
  std::vector<std::string> sentences;
  for (const std::size_t cost : {std::size_t{0}, std::size_t{1}}) {
    const auto more = analysis::describe_front(scope, analysis::make_trade_front(scope, 0, cost), gl);
    sentences.insert(sentences.end(), more.begin(), more.end());
  }
  return sentences;
}

std::string html_crossovers(const std::vector<records::CellRecord>& cells, const Trade& trade) {
  const auto growth = analysis::describe_growth(cells);
  std::string text;
  if (!trade.charts.empty()) {
    text += "<h3>From which kernel on a prefiltered map pays</h3>\n" +
            page::html_list(analysis::describe_crossovers(trade.charts));
    text +=
        "<p class=\"note\">A radius counts where both were measured, or one was and the other is interpolated between "
        "its "
        "neighbours; cheaper is said where the 95 % intervals do not overlap. Crosses mark where the medians "
        "meet.</p>\n";
    text += html_plot("radius", "Time over kernel radius",
                      html_select("radius-place", "where") + html_select("radius-light", "light"));
  }
  if (!growth.empty()) text += "<h3>How times grow</h3>\n" + page::html_list(growth);
  return text;
}

constexpr const char* kLightsTitle = "How a frame's cost grows with its lights";
constexpr const char* kLightsNote =
    "Light 0 is the scene's; the others are it, turned about the vertical in equal steps, each with a frustum, a depth "
    "map and an encoded map of its own. Still: maps "
    "and prefilters are kept, and each light is looked up; moving: all of them are drawn in every frame. Shading is "
    "left out. In brackets: the 95 % interval of the "
    "per-round ratio to the reference under as many lights, times its median (quartiles where the run does not hold "
    "the reference); cheaper is said where these do not "
    "overlap. Growth is fitted to each filter's own medians, in brackets what its quartiles allow: each number of "
    "lights is timed in rounds of its own, and drift of the "
    "machine between them is in the growth, not in the order.";

std::vector<std::string> describe_lights(const Trade& trade, const records::GlRecord& gl) {
  std::vector<std::string> sentences = analysis::describe_light_order(trade.lights);
  const auto growth = analysis::describe_light_growth(trade.lights, gl);
  sentences.insert(sentences.end(), growth.begin(), growth.end());
  return sentences;
}

std::string name_light_table(const analysis::LightChart& chart, const records::GlRecord& gl) {
  return fmt::format("{}: time of a frame, ms: {}", chart.title, records::describe_clock(gl));
}

std::string html_lights(const records::RunRecord& run, const Trade& trade) {
  if (trade.lights.empty()) return {};
  std::string text = fmt::format("<h3 id=\"lights\">{}</h3>\n", page::escape_html(kLightsTitle)) +
                     page::html_list(describe_lights(trade, run.gl));
  text += "<p class=\"note\">" + page::escape_html(kLightsNote) + "</p>\n";
  for (const analysis::LightChart& chart : trade.lights) {
    if (!trade.no_plots && chart.counts.size() > 1)
      text += page::figure(light_plot_file(chart), chart.title + ": time of a frame over its lights", "grid");
    text += page::html_table(analysis::make_light_table(chart), name_light_table(chart, run.gl), "cost");
  }
  return text;
}

std::string html_static_plots(const Trade& trade) {
  if (trade.no_plots)
    return "<p class=\"note\">No plots for documents: " + page::escape_html(*trade.no_plots) + ".</p>\n";
  std::string items;
  for (const page::Plot& plot : trade.plots) items += "<li>" + page::link(plot.file, plot.file) + "</li>\n";
  return "<details><summary>Plots for documents (SVG)</summary>\n<ul>\n" + items + "</ul>\n<p>Drawn by " +
         page::link("plots/plots.gp", "plots/plots.gp") + ", which gnuplot runs.</p></details>\n";
}

std::string markdown_list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += "- " + page::escape_markdown(item) + "\n";
  return text + "\n";
}

std::string markdown_fronts(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                            const Trade& trade) {
  std::string text;
  for (const analysis::TradeScope& scope : trade.scopes)
    text += "### " + page::escape_markdown(scope.title) + "\n\n" + markdown_list(describe_scope(scope, run.gl));
  const auto crossovers = analysis::describe_crossovers(trade.charts), growth = analysis::describe_growth(cells);
  if (!crossovers.empty()) text += "### From which kernel on a prefiltered map pays\n\n" + markdown_list(crossovers);
  if (!growth.empty()) text += "### How times grow\n\n" + markdown_list(growth);
  return text + "### How to read the fronts\n\n" + markdown_list(analysis::explain_fronts());
}

std::string markdown_lights(const records::RunRecord& run, const Trade& trade) {
  if (trade.lights.empty()) return {};
  std::string text = fmt::format("### {}\n\n{}{}\n\n", kLightsTitle, markdown_list(describe_lights(trade, run.gl)),
                                 page::escape_markdown(kLightsNote));
  for (const analysis::LightChart& chart : trade.lights)
    text += page::escape_markdown(name_light_table(chart, run.gl)) + ":\n\n" +
            page::write_markdown_table(analysis::make_light_table(chart)) + "\n";
  return text;
}

}  // namespace

std::optional<Trade> make_trade(const records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  Trade trade;
  trade.scopes = analysis::make_trade_scopes(cells);
  trade.has_fronts = analysis::has_trade(trade.scopes);
  trade.lights = analysis::make_light_charts(cells, trade.scopes);
  if (!trade.has_fronts && trade.lights.empty()) return std::nullopt;
  const auto filters = analysis::list_filters(cells);
  if (trade.has_fronts) {
    trade.charts = analysis::make_radius_charts(cells, trade.scopes);
    trade.plots = make_front_plots(trade.scopes, filters, run.gl);
    for (page::Plot& plot : make_radius_plots(trade.charts, filters, run.gl)) trade.plots.push_back(std::move(plot));
  }
  for (page::Plot& plot : make_light_plots(trade.lights, filters, run.gl)) trade.plots.push_back(std::move(plot));
  return trade;
}

std::string make_trade_html(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                            const Trade& trade) {
  const std::string selects =
      html_select("front-scope", "scene") + html_select("front-error", "error") + html_select("front-cost", "cost");
  if (!trade.has_fronts)
    return "<section id=\"trade\">\n<h2>The trade: what less error costs</h2>\n" + html_lights(run, trade) +
           html_static_plots(trade) + "</section>\n";
  std::string text = fmt::format(
      "<section id=\"trade\">\n<style>\n{}</style>\n<h2>The trade: what less error costs</h2>\n", page::trade_style());
  text +=
      "<p class=\"note\">Lower left is better. Filled and joined: the front, the cells that no other beats. Hollow: "
      "cannot be told "
      "from a cell of the front, to which a dotted line leads. Faint: beaten. Whiskers are intervals. Point at a cell "
      "for its "
      "numbers, click it for its pictures.</p>\n";
  text += html_plot("front", "Error against cost of all cells", selects);
  text += "<div id=\"front-words\">" + page::html_list(describe_scope(trade.scopes.front(), run.gl)) + "</div>\n";
  text += "<div id=\"front-pictures\" aria-live=\"polite\"></div>\n";
  text += "<details><summary>How to read the fronts</summary>\n" + page::html_list(analysis::explain_fronts()) +
          "<p>All fronts, cell by cell: " + page::link("fronts.csv", "fronts.csv") + ".</p></details>\n";
  text += html_crossovers(cells, trade) + html_lights(run, trade) + html_static_plots(trade);
  text += "<script type=\"application/json\" id=\"trade-data\">" +
          dump_for_script(make_trade_data(run, cells, trade.scopes, trade.charts)) +
          "</script>\n<script src=\"chart.min.js\"></script>\n";
  return text + fmt::format("<script>\n{}</script>\n</section>\n", page::trade_script());
}

std::string make_trade_markdown(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                const Trade& trade) {
  std::string text = "## The trade: what less error costs\n\n";
  if (trade.has_fronts) text += markdown_fronts(run, cells, trade);
  text += markdown_lights(run, trade);
  if (trade.no_plots) text += "No plots for documents: " + page::escape_markdown(*trade.no_plots) + ".\n\n";
  if (!trade.has_fronts) return text;
  text += "### Columns of fronts.csv\n\n";
  for (const CsvColumn& column : list_front_columns())
    text += fmt::format("- `{}`: {}\n", column.name, page::escape_markdown(column.meaning));
  return text + "\n";
}

}  // namespace shadowbench::pages
