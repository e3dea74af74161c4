#pragma once

#include <string_view>

namespace shadowbench::report {

/// Returns the style sheet of index.html: report/page.css.
std::string_view page_style();

}  // namespace shadowbench::report
