#pragma once

#include <string_view>

namespace shadowbench::page {

/// The style sheet of every page: report/page/page.css.
std::string_view page_style();

/// The script that draws the charts of a page: report/page/charts.js.
std::string_view chart_script();

}  // namespace shadowbench::page
