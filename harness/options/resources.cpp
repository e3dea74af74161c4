#include <fmt/format.h>

#include <cstdlib>

#include "filters/base/error.h"
#include "harness/options/options.h"

namespace shadowbench::options {

Resources find_resources() {
  const char* chosen = std::getenv("SHADOWBENCH_ROOT");
  const std::filesystem::path root = chosen ? chosen : SHADOWBENCH_BUILT_FROM;
  Resources resources{root / "filters", root / "shaders", root / "harness" / "scenes",
                      root / "harness" / "experiments"};
  for (const auto& folder : {resources.filters, resources.shaders, resources.scenes, resources.experiments}) {
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
