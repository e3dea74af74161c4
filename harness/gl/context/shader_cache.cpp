#include "harness/gl/context/shader_cache.h"

#include <fmt/format.h>
#include <sys/statvfs.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace shadowbench::gl {
namespace {

constexpr std::uintmax_t kLeastFree = std::uintmax_t{16} << 20;  // ten times Mesa's index

std::filesystem::path find_cache_folder() {
  for (const char* name : {"MESA_SHADER_CACHE_DIR", "XDG_CACHE_HOME"})
    if (const char* folder = std::getenv(name); folder && *folder) return folder;
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home ? home : "/") / ".cache";
}

/// Free bytes where the folder is, or will be.
std::optional<std::uintmax_t> count_free(std::filesystem::path folder) {
  struct statvfs disk {};
  while (statvfs(folder.c_str(), &disk) != 0) {
    if (!folder.has_parent_path() || folder == folder.parent_path()) return std::nullopt;
    folder = folder.parent_path();
  }
  return std::uintmax_t{disk.f_bavail} * disk.f_frsize;
}

}  // namespace

std::string disable_shader_cache_on_full_disk() {
  constexpr const char* kSwitch = "MESA_SHADER_CACHE_DISABLE";
  if (std::getenv(kSwitch)) return {};
  const std::filesystem::path folder = find_cache_folder();
  const std::optional<std::uintmax_t> free = count_free(folder);
  if (!free || *free >= kLeastFree) return {};
  setenv(kSwitch, "true", 1);
  return fmt::format("the driver's cache of shaders in {}, where {} KB are free", folder.string(), *free >> 10);
}

}  // namespace shadowbench::gl
