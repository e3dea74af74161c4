#pragma once

#include <string>
#include <string_view>

namespace shadowbench::records {

/// Begins the reason of a value that has nothing to be measured on: the fault it counts cannot occur there, which is
/// something else than a value that nobody measured. Stands in `absent`, for readers of results.json too.
inline constexpr std::string_view kNothingToSee = "nothing to see: ";

/// Makes the reason of a value that has nothing to be measured on; `why` says what there is too little of.
std::string explain_nothing_to_see(std::string_view why);

/// Does a reason of `absent` say that there is nothing on which the value could be measured?
bool is_nothing_to_see(std::string_view reason);

}  // namespace shadowbench::records
