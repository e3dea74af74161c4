#pragma once

#include <string_view>

namespace shadowbench::page {

/// Returns the style sheet of index.html: report/page.css.
std::string_view page_style();

/// Returns what bias.html adds to it: report/bias_page.css.
std::string_view bias_page_style();

/// Returns the style sheet, and the script, of the trade in index.html: report/trade_page.css and .js.
std::string_view trade_style();
std::string_view trade_script();

/// The script that draws the charts of a page: report/page/charts.js.
std::string_view chart_script();

/// Returns the plotting library that the script draws with: Chart.js (MIT licence, said in its first lines).
std::string_view chart_library();

}  // namespace shadowbench::page
