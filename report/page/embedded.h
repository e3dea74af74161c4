#pragma once

#include <string_view>

namespace shadowbench::page {

/// Returns the style sheet of index.html: report/page.css.
std::string_view page_style();

/// Returns what bias.html adds to it: report/bias_page.css.
std::string_view bias_page_style();

/// The script that draws the charts of a page: report/page/charts.js.
std::string_view chart_script();

/// Returns the plotting library that the script draws with: Chart.js (MIT licence, said in its first lines).
std::string_view chart_library();

}  // namespace shadowbench::page
