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

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Runs `action`, which may refuse its input with an Error; anything else that it throws is a finding.
template <typename Action>
void allow_refusal(const Action& action) {
  try {
    action();
  } catch (const Error&) {
    return;
  }
}

}  // namespace shadowbench::fuzz
