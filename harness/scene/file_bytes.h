#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace shadowbench::scene {

/// Reads a whole file. Throws kInput where it is missing, not a regular file or unreadable.
std::vector<unsigned char> read_file_bytes(const std::filesystem::path& file);

/// Resolves a reference found in a file of `folder`; nothing where it would leave that folder ("../x", "/etc/passwd").
/// Links inside the folder are the user's own and are followed.
std::optional<std::filesystem::path> resolve_inside(const std::filesystem::path& folder, std::string_view reference);

}  // namespace shadowbench::scene
