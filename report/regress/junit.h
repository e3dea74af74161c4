#pragma once

#include <string>

#include "report/regress/regress.h"

namespace shadowbench::regress {

/// Writes a comparison as JUnit XML, which build servers show: a suite per scene, a case per cell.
/// Source: the subset of the format that the readers of Jenkins and GitLab share.
std::string make_junit(const RegressReport& report);

}  // namespace shadowbench::regress
