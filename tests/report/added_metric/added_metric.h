#pragma once

#include <optional>

namespace shadowbench::metrics {

/// The value of the metric "artefact.banding", which only this program's table has.
inline std::optional<double> added_value;

}  // namespace shadowbench::metrics
