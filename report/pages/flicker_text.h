#pragma once

#include <string>
#include <vector>

#include "report/pages/text_tables.h"
#include "report/records/flicker_record.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {

/// Says what each number of the report is, a sentence each.
std::vector<std::string> define_flicker(const records::FlickerRecord& record);

/// Says how a motion was made, and what is uncertain.
std::vector<std::string> explain_motion(const records::FlickerMotion& motion, int frames);

/// Says what a motion's numbers show: who flickers most and least, against the truth, and what snapping buys.
std::vector<std::string> describe_flicker(const records::FlickerMotion& motion);

/// Makes a motion's table: one row per filter, without and with snapping.
records::TextTable make_flicker_table(const records::FlickerMotion& motion);

/// Makes flicker.md.
std::string make_flicker_text(const records::FlickerRecord& record);

/// Makes flicker.html: one page that opens from disk and loads nothing but its own pictures, by relative links.
std::string make_flicker_html(const records::FlickerRecord& record);

}  // namespace shadowbench::pages
