#pragma once

#include <string>
#include <string_view>

#include "report/records/records.h"

namespace shadowbench::records {

/// The beginning of the reason of a value that has nothing to be measured on, since its fault cannot occur there: that
/// is not a value that nobody measured. Readers of results.json find it in `absent`.
inline constexpr std::string_view kNothingToSee = "nothing to see: ";

/// Makes such a reason; `why` says what there is too little of.
std::string explain_nothing_to_see(std::string_view why);

/// Whether a reason of `absent` begins like that.
bool is_nothing_to_see(std::string_view reason);

/// Why a cell lacks a value: what `absent` holds for the field, for a group that it is in, or for a part of it;
/// "not measured" where it holds nothing.
std::string explain_absence(const CellRecord& cell, const std::string& field);

}  // namespace shadowbench::records
