#pragma once

#include <filesystem>

namespace shadowbench::submit {

/// Writes the report of a sweep whose tasks are all finished, of the cells that they left in its folder; it equals that
/// of one run of the whole experiment in everything but times, load and work done.
/// Throws Error(kLimit) where cells are missing; nothing is written then. Throws Error(kInput) where no sweep was
/// submitted into the folder, Error(kOutput). Cost: no picture is read or copied.
void merge_sweep(const std::filesystem::path& out);

}  // namespace shadowbench::submit
