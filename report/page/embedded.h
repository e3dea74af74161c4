#pragma once

#include <string_view>

namespace shadowbench::page {

/// The style sheet of every page: report/page/page.css and viewer.css.
std::string_view page_style();

/// The scripts that fill the mounts of a run's page: values.js, viewer.js, table.js and answer.js.
std::string_view run_script();

/// The script that draws the charts of a page: report/page/charts.js.
std::string_view chart_script();

}  // namespace shadowbench::page
