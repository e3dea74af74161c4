#include <fmt/format.h>

#include <cstdlib>

#include "base/error.h"
#include "harness/options/options.h"

namespace shadowbench::options {

namespace {

/// The folder that holds what comes with the program: the one that the user names, else the one that is installed
/// beside this program, else the sources that it was built from.
std::filesystem::path choose_root() {
  if (const char* chosen = std::getenv("SHADOWBENCH_ROOT")) return chosen;
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path installed = program.parent_path().parent_path() / "share" / "shadowbench";
  return std::filesystem::is_directory(installed / "filters", ignored) ? installed : SHADOWBENCH_BUILT_FROM;
}

}  // namespace

Resources find_resources() {
  const std::filesystem::path root = choose_root();
  const std::filesystem::path data = root / "data";
  Resources resources{root / "filters",     root / "shaders", data / "scenes",
                      data / "experiments", data / "gpus",    data / "lessons.toml"};
  for (const auto& folder :
       {resources.filters, resources.shaders, resources.scenes, resources.experiments, resources.gpus}) {
    if (std::filesystem::is_directory(folder)) continue;
    throw Error(ErrorKind::kUsage,
                "this folder of the program is missing: set SHADOWBENCH_ROOT to a checkout of the project",
                folder.string());
  }
  return resources;
}

std::filesystem::path default_cache_folder() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg == '/')
    return std::filesystem::path(xdg) / "shadowbench";
  if (const char* home = std::getenv("HOME"); home && *home == '/')
    return std::filesystem::path(home) / ".cache" / "shadowbench";
  return {};
}

}  // namespace shadowbench::options
