#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace shadowbench::scene {

/// Reads a whole file. Throws kInput where it is missing, not a regular file or unreadable.
std::vector<unsigned char> read_file_bytes(const std::filesystem::path& file);

/// Resolves a reference found in a file of `folder`, as it stands: percent signs are decoded by then. Nothing where it
/// would leave that folder: by "../x" or "/etc/passwd", by a symbolic link on its way, or by a NUL that hides its end.
/// Links that stay in the folder are followed, and so is one that the folder itself is reached by.
std::optional<std::filesystem::path> resolve_inside(const std::filesystem::path& folder, std::string_view reference);

}  // namespace shadowbench::scene
