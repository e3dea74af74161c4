#pragma once

#include <string>

#include "report/regress/regress.h"

namespace shadowbench::regress {

/// Gives the command that accepts what differs, as it would be typed.
std::string make_accept_command(const RegressOptions& options);

/// Says in a line how many cells are as they were, and how many are not: "49 compared: 48 same, 1 less accurate".
std::string describe_counts(const RegressReport& report);

/// Names the worst cell and what is wrong with it, in a line. Requires one that failed.
std::string describe_worst(const RegressReport& report);

/// Says for people what differs, the worst first, and how to accept it.
std::string make_regress_text(const RegressReport& report);

/// Writes the same for programs.
std::string make_regress_json(const RegressReport& report);

}  // namespace shadowbench::regress
