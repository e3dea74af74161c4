#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "base/input_file.h"

namespace shadowbench::scene {

/// Resolves a reference that a file in `folder` makes; percent signs must be decoded already. Returns nothing if it
/// would leave that folder: by "../x" or "/etc/passwd", by a symbolic link, or by a NUL that hides its end. Links that
/// stay inside are followed, and the folder itself may be reached by one.
std::optional<std::filesystem::path> resolve_inside(const std::filesystem::path& folder, std::string_view reference);

}  // namespace shadowbench::scene
