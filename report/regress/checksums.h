#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace shadowbench::regress {

/// The file that lists the checksums of a baseline.
inline constexpr const char* kChecksumFile = "checksums.txt";

/// SHA-256 of files in hexadecimal digits, by path below the baseline's folder; empty where it cannot be read.
using Checksums = std::map<std::string, std::string>;

/// What is wrong with files of a baseline, by path below its folder: "has changed since it was accepted".
using Damage = std::map<std::string, std::string>;

/// Computes the checksums of all that a baseline consists of: tolerances, log, numbers and images. Other files may lie
/// beside them.
Checksums compute_checksums(const std::filesystem::path& folder);

/// Reads the list of a baseline, as far as it can be read; nothing where there is none.
Checksums read_checksums(const std::filesystem::path& folder);

/// Writes a list that `sha256sum -c` checks, too. Throws Error(kOutput).
void write_checksums(const std::filesystem::path& folder, const Checksums& checksums);

/// Compares a baseline with its list; a folder that has nothing of a baseline has no damage.
Damage find_damage(const std::filesystem::path& folder);

}  // namespace shadowbench::regress
