#pragma once

#include <string>

namespace shadowbench::records {

/// Lists the metrics of the table for people: path, unit, range, direction and definition of each.
std::string make_metric_text();

/// Lists them as a JSON array.
std::string make_metric_json();

}  // namespace shadowbench::records
