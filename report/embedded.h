#pragma once

#include <string_view>

namespace shadowbench::report {

/// Returns the style sheet of index.html: report/page.css.
std::string_view page_style();

/// Returns what bias.html adds to it: report/bias_page.css.
std::string_view bias_page_style();

}  // namespace shadowbench::report
