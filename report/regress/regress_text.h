#pragma once

#include <string>

#include "report/document/blocks.h"
#include "report/regress/regress.h"

namespace shadowbench::regress {

/// How many cells that differ are described one by one; the others are counted, or listed in a table.
inline constexpr std::size_t kMostListed = 20, kMostListedBriefly = 5;

/// The command that accepts what differs, as it would be typed.
std::string make_accept_command(const RegressOptions& options);

/// Says for people what differs, the worst first, and how to accept it.
std::string make_regress_text(const RegressReport& report);

/// Makes regress.json: the same for programs.
std::string make_regress_json(const RegressReport& report);

/// Sums a comparison up. A difference that was accepted is no failure; one that could not be accepted is.
std::string describe_failure(const RegressReport& report);

/// Makes the page of `shadowbench regress`: what differs, the worst first, with its pictures, and how to accept it.
document::Page make_regress_page(const RegressReport& report);

/// Writes a comparison as JUnit XML, which build servers show: a suite per scene, a case per cell.
/// Source: the subset of the format that the readers of Jenkins and GitLab share.
std::string make_junit(const RegressReport& report);

}  // namespace shadowbench::regress
