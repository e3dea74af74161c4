#include "base/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/files.h"

namespace shadowbench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = ".shadowbench-lock";
constexpr const char* kMark = ".shadowbench-folder";

[[noreturn]] void refuse_folder(const std::filesystem::path& folder, int code) {
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

bool is_plain(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() == fs::file_type::regular;
}

/// Whether it is a record of ours: each names a schema, and the program.
bool is_record(const fs::path& file) {
  if (file.extension() != ".json" || !is_plain(file)) return false;
  std::string head(std::size_t{1} << 20, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head.find("\"schema") != head.npos && head.find("shadowbench") != head.npos;
}

template <class Condition>
bool has_entry(const fs::path& folder, const Condition& holds) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (holds(entry->path())) return true;
  return false;
}

/// Whether this program made the folder. A copy may have lost its mark.
bool is_ours(const fs::path& folder) {
  return is_plain(folder / kMark) || is_plain(folder / kLock) || has_entry(folder, is_record);
}

/// It has its name at once, so that another process which is given the folder at the same time finds no other content.
void put_mark(const fs::path& folder) {
  const int descriptor = open((folder / kMark).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno != EEXIST) refuse_folder(folder, errno);
  if (descriptor >= 0) close(descriptor);
}

/// Whether it holds anything but folders of ours: `report/out` is made for `report/out/stress` too.
bool has_other_content(const fs::path& folder) {
  return has_entry(
      folder,
      [](const fs::path& entry) {
        std::error_code ignored;
        const bool is_folder = fs::symlink_status(entry, ignored).type() == fs::file_type::directory;
        return !is_folder || (!is_ours(entry) && has_other_content(entry));
      });
}

/// Whether the file system has no such locks, like some network file systems.
bool has_no_locks(int code) { return code == ENOLCK || code == ENOSYS || code == EOPNOTSUPP; }

}  // namespace

void require_no_links(const fs::path& folder, ErrorKind kind) {
  std::error_code error, gone;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_symlink(gone))
      throw Error(kind, "this is a link, which may lead anywhere: remove it, or put in its place what it leads to",
                  entry->path().string());
}

FolderLock::FolderLock(fs::path folder, bool takes_any) : folder_(std::move(folder)), file_(folder_ / kLock) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) refuse_folder(folder_, error.value());
  const bool is_own = is_ours(folder_);
  if (!takes_any && !is_own && has_other_content(folder_))
    throw Error(ErrorKind::kOutput,
                "there are files in this folder that this program did not write, and might replace or remove; choose "
                "an empty or new one, or give --force",
                folder_.string());
  require_no_links(folder_, ErrorKind::kOutput);
  if (!takes_any && !is_own) put_mark(folder_);
  while (!try_to_take()) {
  }
  const std::string owner = fmt::format("{}\n", getpid());
  if (ftruncate(descriptor_, 0) != 0 ||
      pwrite(descriptor_, owner.data(), owner.size(), 0) != static_cast<ssize_t>(owner.size())) {
    const int code = errno;
    unlink(file_.c_str());
    close(descriptor_);
    refuse_folder(folder_, code);
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
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor_ < 0) refuse_folder(folder_, errno);
  struct stat opened {};
  if (fstat(descriptor_, &opened) != 0 || !S_ISREG(opened.st_mode) || opened.st_nlink > 1) {
    close(descriptor_);
    throw Error(ErrorKind::kOutput,
                "this is to be a lock, which is written, but it is a link, a pipe or a device: remove it",
                file_.string());
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && !has_no_locks(errno)) {
    const int code = errno;
    const std::string owner = code == EWOULDBLOCK ? read_owner(descriptor_) : "";
    close(descriptor_);
    if (owner.empty()) refuse_folder(folder_, code);
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

}  // namespace shadowbench
