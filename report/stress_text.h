#pragma once

#include <string>
#include <vector>

#include "report/stress_record.h"
#include "report/text_tables.h"

namespace shadowbench::report {

/// Makes an axis' table of what is safe: a row per case, with the last value that is ok and the first ones that are
/// not.
TextTable make_case_table(const StressAxis& axis);

/// Makes the table of measured against theoretical limits over all axes; one row per limit that was met, or should have
/// been.
TextTable make_limit_table(const StressRecord& record);

/// Says of each axis how many limits the table leaves out: those that theory puts beyond the range, or says that there
/// are none, and that were not met.
std::vector<std::string> describe_out_of_sight(const StressRecord& record);

/// Lists the limits of an axis that are not what theory says: those explained, and those that are not.
std::vector<std::string> describe_explanations(const StressAxis& axis);
std::vector<std::string> describe_disagreements(const StressAxis& axis);

/// Lists the cases of an axis that were not measured, with the reason.
std::vector<std::string> describe_absences(const StressAxis& axis);

/// Lists what else was seen on an axis: verdicts that got better again, and remarks of the axis.
std::vector<std::string> describe_notes(const StressAxis& axis);

/// Makes the tables of an axis' safe values, and of all limits, for a terminal.
std::string make_limit_tables(const StressRecord& record);

/// Says in a sentence what an axis measures, over which range, and what its verdicts mean.
std::string describe_axis(const StressAxis& axis);

/// Makes stress.md.
std::string make_stress_text(const StressRecord& record);

/// Makes stress.html: one page that opens from disk and loads nothing but the pictures and plots that it names.
std::string make_stress_html(const StressRecord& record);

}  // namespace shadowbench::report
