#pragma once

#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::analysis {

/// What a filter may claim whose penumbrae are narrow where caster and receiver touch, and widen with their distance.
inline constexpr const char* kContactHardening = "contact-hardening";

/// Holds what a configuration's filter claims of itself against what its cells show: says why a claim is not shown;
/// empty where it is. Every place that can show it must; a place that cannot says nothing. Of contact hardening the
/// growth of penumbrae decides, of another claim nothing is measured.
std::string find_doubt(const std::vector<const records::CellRecord*>& cells, const std::string& claim);

/// Whether a configuration's filter claims something, and shows it.
bool shows_claim(const std::vector<const records::CellRecord*>& cells, const std::string& claim);

}  // namespace shadowbench::analysis
