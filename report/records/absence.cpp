#include "report/records/absence.h"

namespace shadowbench::records {

std::string explain_nothing_to_see(std::string_view why) { return std::string(kNothingToSee) + std::string(why); }

bool is_nothing_to_see(std::string_view reason) { return reason.starts_with(kNothingToSee); }

}  // namespace shadowbench::records
