#include "base/atomic_file.h"

#include <fmt/format.h>

#include <cassert>
#include <cerrno>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/temporary_files.h"

namespace shadowbench {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code) {
  throw Error(ErrorKind::kOutput,
              fmt::format("{} ({}); check the folder's rights and free space, or choose another with --out", what,
                          std::generic_category().message(code)),
              path.string());
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path path) : path_(std::move(path)), temporary_(make_temporary_path(path_)) {
  std::error_code error;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
  if (error) fail(path_.parent_path(), "the folder cannot be created", error.value());
  std::filesystem::remove(temporary_, error);  // a link of that name would be written through
}

PendingFile::~PendingFile() {
  if (!committed_) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
}

void PendingFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error == std::errc::no_such_file_or_directory) {
    throw Error(ErrorKind::kOutput,
                "its folder was removed or replaced while the file was written; run the same command again, or choose "
                "another with --out",
                path_.string());
  }
  if (error) fail(path_, "the file cannot be given its name", error.value());
  committed_ = true;
}

AtomicFile::AtomicFile(std::filesystem::path path)
    : pending_(std::move(path)), file_(std::fopen(pending_.temporary_path().c_str(), "wbx")) {
  if (!file_) fail(pending_.path(), "the file cannot be created", errno);
}

void AtomicFile::write(std::string_view text) {
  assert(file_);
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size())
    fail(pending_.path(), "the file cannot be written", errno);
}

void AtomicFile::commit() {
  if (std::fclose(file_.release()) != 0) fail(pending_.path(), "the file cannot be written", errno);
  pending_.commit();
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

void copy_whole_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  PendingFile pending(to);
  std::error_code error;
  std::filesystem::copy_file(from, pending.temporary_path(), error);
  if (error)
    throw Error(
        ErrorKind::kOutput,
        fmt::format(
            "it cannot be copied to {} ({}); check rights and free space there, or choose another folder with --out",
            to.string(), error.message()),
        from.string());
  pending.commit();
}

}  // namespace shadowbench
