#include "report/files/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/temporary_files.h"

namespace shadowbench::files {
namespace {

constexpr const char* kName = ".shadowbench-lock";

[[noreturn]] void fail(const std::filesystem::path& folder, int code) {
  throw Error(
      ErrorKind::kOutput,
      fmt::format(
          "nothing can be written into this folder ({}); check its rights and free space, or choose another with --out",
          std::generic_category().message(code)),
      folder.string());
}

/// Reads which process holds the lock, and waits a moment for it to write its number.
std::string read_owner(int descriptor) {
  for (int tries = 0; tries < 50; ++tries) {
    char text[32] = {};
    if (pread(descriptor, text, sizeof text - 1, 0) > 0 && std::strchr(text, '\n'))
      return fmt::format("process {}", std::strtol(text, nullptr, 10));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return "another process";
}

/// Whether the file system has no such locks, like some network file systems.
bool has_no_locks(int code) { return code == ENOLCK || code == ENOSYS || code == EOPNOTSUPP; }

}  // namespace

FolderLock::FolderLock(std::filesystem::path folder) : folder_(std::move(folder)), file_(folder_ / kName) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) fail(folder_, error.value());
  while (!try_to_take()) {
  }
  const std::string owner = fmt::format("{}\n", getpid());
  if (ftruncate(descriptor_, 0) != 0 ||
      pwrite(descriptor_, owner.data(), owner.size(), 0) != static_cast<ssize_t>(owner.size())) {
    const int code = errno;
    unlink(file_.c_str());
    close(descriptor_);
    fail(folder_, code);
  }
  remove_temporary_files(folder_, [](const Writer&) { return true; });
}

FolderLock::~FolderLock() {
  if (is_in_place()) unlink(file_.c_str());
  close(descriptor_);
}

void FolderLock::require_in_place() const {
  if (is_in_place()) return;
  throw Error(ErrorKind::kOutput,
              "this folder was removed or replaced while it was written; run the same command again, or choose another "
              "with --out",
              folder_.string());
}

/// Gives false where the file that was locked is no longer the one of that name: its owner has just removed it.
bool FolderLock::try_to_take() {
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(folder_, errno);
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && !has_no_locks(errno)) {
    const int code = errno;
    const std::string owner = code == EWOULDBLOCK ? read_owner(descriptor_) : "";
    close(descriptor_);
    if (owner.empty()) fail(folder_, code);
    throw Error(ErrorKind::kOutput,
                fmt::format("{} writes into this folder; wait until it ends, or choose another with --out", owner),
                folder_.string());
  }
  if (is_in_place()) return true;
  close(descriptor_);
  return false;
}

bool FolderLock::is_in_place() const {
  struct stat taken {
  }, named{};
  return fstat(descriptor_, &taken) == 0 && stat(file_.c_str(), &named) == 0 && taken.st_ino == named.st_ino &&
         taken.st_dev == named.st_dev;
}

}  // namespace shadowbench::files
