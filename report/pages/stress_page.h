#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/document/blocks.h"
#include "report/records/stress_record.h"

namespace shadowbench::pages {

/// An axis' table of what is safe: a row per case, with its last value that is ok and the first ones that are not.
records::TextTable make_case_table(const records::StressAxis& axis);

/// Measured beside theoretical limits over all axes: a row per limit that was met, or should
/// have been.
records::TextTable make_limit_table(const records::StressRecord& record);

/// The limits of an axis that compare so with theory: in words, with the reason or that there is none.
std::vector<std::string> describe_stress_limits(const records::StressAxis& axis, records::StressAgreement agreement);

/// Draws what was measured over an axis' quantity: a line per case, the same colour for the levels of one variant, the
/// model's dashed; broken points filled, at the upper edge where nothing finite was measured; the bound dashed,
/// and the theoretical limits dotted. Zeros are left out where the scale is logarithmic. Nothing where
/// nothing was observed.
std::optional<document::Chart> make_stress_chart(const records::StressAxis& axis);

/// Makes the page of `shadowbench stress`.
document::Page make_stress_page(const records::StressRecord& record);

}  // namespace shadowbench::pages
