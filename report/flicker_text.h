#pragma once

#include <string>
#include <vector>

#include "report/flicker_record.h"
#include "report/text_tables.h"

namespace shadowbench::report {

/// Says what each number of the report is, a sentence each.
std::vector<std::string> define_flicker(const FlickerRecord& record);

/// Says how a motion was made, and what is uncertain.
std::vector<std::string> explain_motion(const FlickerMotion& motion, int frames);

/// Says what a motion's numbers show: who flickers most and least, against the truth, and what snapping buys.
std::vector<std::string> describe_flicker(const FlickerMotion& motion);

/// Makes a motion's table: one row per filter, without and with snapping.
TextTable make_flicker_table(const FlickerMotion& motion);

/// Makes flicker.md.
std::string make_flicker_text(const FlickerRecord& record);

/// Makes flicker.html: one page that opens from disk and loads nothing but its own pictures, by relative links.
std::string make_flicker_html(const FlickerRecord& record);

}  // namespace shadowbench::report
