#include "report/absence.h"

namespace shadowbench::report {

std::string explain_nothing_to_see(std::string_view why) { return std::string(kNothingToSee) + std::string(why); }

bool is_nothing_to_see(std::string_view reason) { return reason.starts_with(kNothingToSee); }

}  // namespace shadowbench::report
