#include "filters/base/input_file.h"

#include <fmt/format.h>

namespace shadowbench {

void require_plain_file(const std::filesystem::path& file, std::uintmax_t most_bytes, ErrorKind kind) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (failure || !exists(status) || is_directory(status)) return;
  if (!is_regular_file(status))
    throw Error(kind, "this is a device, a pipe or a socket: name a file, into which it may be copied first",
                file.string());
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  if (failure || bytes <= most_bytes) return;
  throw Error(kind,
              fmt::format("it has {} MiB, and {} MiB are the most that are read here", bytes / kMebibyte,
                          most_bytes / kMebibyte),
              file.string());
}

}  // namespace shadowbench
