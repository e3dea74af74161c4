#include "base/input_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

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

std::vector<unsigned char> read_file_bytes(const std::filesystem::path& file, std::uintmax_t most_bytes,
                                           ErrorKind kind) {
  const auto fail = [&](const std::string& message) { throw Error(kind, message, file.string()); };
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (!exists(status)) fail("there is no such file");
  if (is_directory(status)) fail("this is not a file");
  require_plain_file(file, most_bytes, kind);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(std::string("cannot be opened: ") + std::strerror(errno));
  std::vector<unsigned char> bytes(static_cast<std::size_t>(std::filesystem::file_size(file)));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) fail("cannot be read to its end");
  return bytes;
}

}  // namespace shadowbench
