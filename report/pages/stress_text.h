#pragma once

#include <string>
#include <vector>

#include "report/pages/text_tables.h"
#include "report/records/stress_record.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {

/// Makes an axis' table of what is safe: a row per case, with the last value that is ok and the first ones that are
/// not.
records::TextTable make_case_table(const records::StressAxis& axis);

/// Makes the table of measured against theoretical limits over all axes; one row per limit that was met, or should have
/// been.
records::TextTable make_limit_table(const records::StressRecord& record);

/// Says of each axis how many limits the table leaves out: those that theory puts beyond the range, or says that there
/// are none, and that were not met.
std::vector<std::string> describe_out_of_sight(const records::StressRecord& record);

/// Lists the limits of an axis that are not what theory says: those explained, and those that are not.
std::vector<std::string> describe_explanations(const records::StressAxis& axis);
std::vector<std::string> describe_disagreements(const records::StressAxis& axis);

/// Lists the cases of an axis that were not measured, with the reason.
std::vector<std::string> describe_absences(const records::StressAxis& axis);

/// Lists what else was seen on an axis: verdicts that got better again, and remarks of the axis.
std::vector<std::string> describe_notes(const records::StressAxis& axis);

/// Makes the tables of an axis' safe values, and of all limits, for a terminal.
std::string make_limit_tables(const records::StressRecord& record);

/// Says in a sentence what an axis measures, over which range, and what its verdicts mean.
std::string describe_axis(const records::StressAxis& axis);

/// Makes stress.md.
std::string make_stress_text(const records::StressRecord& record);

/// Makes stress.html: one page that opens from disk and loads nothing but the pictures and plots that it names.
std::string make_stress_html(const records::StressRecord& record);

}  // namespace shadowbench::pages
