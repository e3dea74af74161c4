#pragma once

#include <string>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/flicker_record.h"

namespace shadowbench::pages {

/// What each number of the report is, a sentence each.
std::vector<std::string> define_flicker(const records::FlickerRecord& record);

/// How a motion was made, and what is uncertain.
std::vector<std::string> explain_motion(const records::FlickerMotion& motion, int frames);

/// Says which filter flickers most and least in a motion, against the truth, without snapping and with it.
std::string summarize_flicker(const records::FlickerMotion& motion);

/// A motion's table: a row per filter, without snapping and with it.
records::TextTable make_flicker_table(const records::FlickerMotion& motion);

/// Draws the mean change of visibility over the steps: a line per filter and a dashed one for the truth. The charts of
/// a motion share their scales.
document::Chart make_flicker_chart(const records::FlickerMotion& motion, const records::FlickerVariant& variant);

/// Makes the page of `shadowbench flicker`.
document::Page make_flicker_page(const records::FlickerRecord& record);

}  // namespace shadowbench::pages
