#pragma once

#include <array>
#include <filesystem>

#include "harness/render/display_pass.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

/// A path in `folder` without an extension, which no file of any extension has yet: "cubes-1".
std::filesystem::path find_free_stem(const std::filesystem::path& folder, const std::string& name);

/// Writes STEM.png, which is what the window shows of both sides, and STEM.exr with the float images behind it: for
/// each side, "left" and "right", its visibility and its picture, and the truth as far as it is traced. `shown` must be
/// valid over the whole picture; `divider` is a column of it.
/// Throws Error(kOutput).
void save_picture(Workbench& bench, render::DisplayPass& display, const std::array<render::DisplayedValues, 2>& shown,
                  float divider, const std::filesystem::path& stem);

}  // namespace shadowbench::view
