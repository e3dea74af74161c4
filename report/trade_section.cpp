#include "report/trade_section.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/embedded.h"
#include "report/front_words.h"
#include "report/growth.h"
#include "report/html.h"
#include "report/html_parts.h"
#include "report/tables.h"
#include "report/trade_data.h"
#include "report/trade_plots.h"
#include "report/trade_table.h"

namespace shadowbench::report {
namespace {

std::string html_select(const std::string& id, const std::string& label) {
  return fmt::format("<label>{} <select id=\"{}\"></select></label>\n", escape_html(label), id);
}

// Drawn by trade_page.js.
std::string html_plot(const std::string& name, const std::string& description, const std::string& selects) {
  return fmt::format(
      "<div class=\"trade-controls\">{2}<button id=\"{0}-save\" type=\"button\">Save as PNG</button></div>\n"
      "<div class=\"trade-canvas\"><canvas id=\"{0}-canvas\" role=\"img\" aria-label=\"{1}\"></canvas></div>\n",
      name, escape_html(description), selects);
}

// RMSE against both times: what is said without scripts, and in summary.md.
std::vector<std::string> describe_scope(const TradeScope& scope, const GlRecord& gl) {
  std::vector<std::string> sentences;
  for (const std::size_t cost : {std::size_t{0}, std::size_t{1}}) {
    const auto more = describe_front(scope, make_trade_front(scope, 0, cost), gl);
    sentences.insert(sentences.end(), more.begin(), more.end());
  }
  return sentences;
}

std::string html_crossovers(const std::vector<CellRecord>& cells, const Trade& trade) {
  const auto growth = describe_growth(cells);
  std::string text;
  if (!trade.charts.empty()) {
    text += "<h3>From which kernel on a prefiltered map pays</h3>\n" + html_list(describe_crossovers(trade.charts));
    text += "<p class=\"note\">A radius counts where both were measured, or one was and the other is interpolated between its "
            "neighbours; cheaper is said where the 95 % intervals do not overlap. Crosses mark where the medians meet.</p>\n";
    text += html_plot("radius", "Time over kernel radius", html_select("radius-place", "where") + html_select("radius-light", "light"));
  }
  if (!growth.empty()) text += "<h3>How times grow</h3>\n" + html_list(growth);
  return text;
}

std::string html_static_plots(const Trade& trade) {
  if (trade.no_plots) return "<p class=\"note\">No plots for documents: " + escape_html(*trade.no_plots) + ".</p>\n";
  std::string items;
  for (const Plot& plot : trade.plots) items += "<li>" + link(plot.file, plot.file) + "</li>\n";
  return "<details><summary>Plots for documents (SVG)</summary>\n<ul>\n" + items + "</ul>\n<p>Drawn by " +
         link("plots/plots.gp", "plots/plots.gp") + ", which gnuplot runs.</p></details>\n";
}

std::string markdown_list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += "- " + escape_markdown(item) + "\n";
  return text + "\n";
}

}  // namespace

std::optional<Trade> make_trade(const RunRecord& run, const std::vector<CellRecord>& cells) {
  Trade trade;
  trade.scopes = make_trade_scopes(cells);
  if (!has_trade(trade.scopes)) return std::nullopt;
  const auto filters = list_filters(cells);
  trade.charts = make_radius_charts(cells, trade.scopes);
  trade.plots = make_front_plots(trade.scopes, filters, run.gl);
  for (Plot& plot : make_radius_plots(trade.charts, filters, run.gl)) trade.plots.push_back(std::move(plot));
  return trade;
}

std::string make_trade_html(const RunRecord& run, const std::vector<CellRecord>& cells, const Trade& trade) {
  const std::string selects = html_select("front-scope", "scene") + html_select("front-error", "error") + html_select("front-cost", "cost");
  std::string text = fmt::format("<section id=\"trade\">\n<style>\n{}</style>\n<h2>The trade: what less error costs</h2>\n", trade_style());
  text += "<p class=\"note\">Lower left is better. Filled and joined: the front, the cells that no other beats. Hollow: cannot be told "
          "from a cell of the front, to which a dotted line leads. Faint: beaten. Whiskers are intervals. Point at a cell for its "
          "numbers, click it for its pictures.</p>\n";
  text += html_plot("front", "Error against cost of all cells", selects);
  text += "<div id=\"front-words\">" + html_list(describe_scope(trade.scopes.front(), run.gl)) + "</div>\n";
  text += "<div id=\"front-pictures\" aria-live=\"polite\"></div>\n";
  text += "<details><summary>How to read the fronts</summary>\n" + html_list(explain_fronts()) + "<p>All fronts, cell by cell: " +
          link("fronts.csv", "fronts.csv") + ".</p></details>\n";
  text += html_crossovers(cells, trade) + html_static_plots(trade);
  text += "<script type=\"application/json\" id=\"trade-data\">" + dump_for_script(make_trade_data(run, cells, trade.scopes, trade.charts)) +
          "</script>\n<script src=\"chart.min.js\"></script>\n";
  return text + fmt::format("<script>\n{}</script>\n</section>\n", trade_script());
}

std::string make_trade_markdown(const RunRecord& run, const std::vector<CellRecord>& cells, const Trade& trade) {
  std::string text = "## The trade: what less error costs\n\n";
  for (const TradeScope& scope : trade.scopes) {
    text += "### " + escape_markdown(scope.title) + "\n\n" + markdown_list(describe_scope(scope, run.gl));
  }
  const auto crossovers = describe_crossovers(trade.charts), growth = describe_growth(cells);
  if (!crossovers.empty()) text += "### From which kernel on a prefiltered map pays\n\n" + markdown_list(crossovers);
  if (!growth.empty()) text += "### How times grow\n\n" + markdown_list(growth);
  text += "### How to read the fronts\n\n" + markdown_list(explain_fronts());
  if (trade.no_plots) text += "No plots for documents: " + escape_markdown(*trade.no_plots) + ".\n\n";
  text += "### Columns of fronts.csv\n\n";
  for (const CsvColumn& column : list_front_columns()) text += fmt::format("- `{}`: {}\n", column.name, escape_markdown(column.meaning));
  return text + "\n";
}

}  // namespace shadowbench::report
