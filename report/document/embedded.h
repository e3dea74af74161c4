#pragma once

#include <string_view>

namespace shadowbench::document {

/// The style sheet of every page: report/document/page.css and viewer.css.
std::string_view page_style();

/// The scripts that fill the mounts of a run's page, from base.js to start.js, as one.
std::string_view run_script();

/// The scripts that draw the charts of a page: base.js, chart_drawing.js and charts.js, as one.
std::string_view chart_script();

}  // namespace shadowbench::document
