#pragma once

#include <filesystem>

#include "report/regress/comparison.h"

namespace shadowbench::regress {

/// Draws what was expected, what was drawn, and the difference, side by side, with the worst place magnified, into a
/// PNG file. Requires two images of one size, not empty, of one channel. Throws Error(kOutput).
void write_regress_picture(const std::filesystem::path& path, const Comparison& comparison,
                           const images::Image& expected, const images::Image& actual);

}  // namespace shadowbench::regress
