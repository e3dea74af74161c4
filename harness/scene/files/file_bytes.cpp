#include "harness/scene/files/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "filters/base/error.h"
#include "filters/base/input_file.h"

namespace shadowbench::scene {

namespace fs = std::filesystem;

namespace {

/// Whether a path begins with all parts of a folder's; both are canonical.
bool is_below(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

std::vector<unsigned char> read_file_bytes(const fs::path& file) {
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (!fs::exists(status)) fail_input("there is no such file", file.string());
  if (fs::is_directory(status)) fail_input("this is not a file", file.string());
  require_plain_file(file, 4096 * kMebibyte);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_input(std::string("cannot be opened: ") + std::strerror(errno), file.string());
  std::vector<unsigned char> bytes(static_cast<std::size_t>(fs::file_size(file)));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) fail_input("cannot be read to its end", file.string());
  return bytes;
}

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
