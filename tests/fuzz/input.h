#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/files.h"

namespace shadowbench::fuzz {

/// Writes a file that a loader is told to read, into a folder of the process's own.
inline std::filesystem::path write_input(const std::string& name, std::string_view bytes) {
  static const ScratchFolder folder(make_temporary_folder_path(std::filesystem::temp_directory_path(), "fuzz"));
  std::filesystem::create_directories(folder.path());
  const std::filesystem::path file = folder.path() / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// What a target does with an input, which it may refuse with an Error; anything else that it throws is a finding.
void try_input(std::string_view text);

}  // namespace shadowbench::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    shadowbench::fuzz::try_input({reinterpret_cast<const char*>(data), size});
  } catch (const shadowbench::Error&) {
  }
  return 0;
}
