#include "harness/scene/files/file_bytes.h"

#include <algorithm>

namespace shadowbench::scene {

namespace fs = std::filesystem;

namespace {

/// Whether a path begins with all parts of a folder's; both are canonical.
bool is_below(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

std::optional<fs::path> resolve_inside(const fs::path& folder, std::string_view reference) {
  if (reference.find('\0') != std::string_view::npos) return std::nullopt;
  const fs::path relative = fs::path(reference).lexically_normal();
  if (relative.is_absolute() || relative.empty() || *relative.begin() == "..") return std::nullopt;
  std::error_code failure;
  const fs::path top = fs::weakly_canonical(folder.empty() ? "." : folder, failure);
  const fs::path target = failure ? fs::path() : fs::weakly_canonical(folder / relative, failure);
  if (failure || !is_below(top, target)) return std::nullopt;
  return folder / relative;
}

}  // namespace shadowbench::scene
