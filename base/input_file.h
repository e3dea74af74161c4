#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/error.h"

namespace shadowbench {

inline constexpr std::uintmax_t kMebibyte = std::uintmax_t{1} << 20;

/// Throws, of this kind, where a path leads to a device, a pipe or a socket, which may have no end, or to a file of
/// more bytes than that. What does not exist, and what is a folder, is the caller's business.
void require_plain_file(const std::filesystem::path& file, std::uintmax_t most_bytes,
                        ErrorKind kind = ErrorKind::kInput);

/// Reads a whole file. Throws likewise, and where it is missing, a folder or unreadable.
std::vector<unsigned char> read_file_bytes(const std::filesystem::path& file,
                                           std::uintmax_t most_bytes = 4096 * kMebibyte,
                                           ErrorKind kind = ErrorKind::kInput);

}  // namespace shadowbench
