#pragma once

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace shadowbench {

/// Reserves a file that appears whole or not at all: write to temporary_path(), then commit().
/// What was not committed is removed. The folder is created where it is missing.
class PendingFile {
 public:
  /// Throws Error(kOutput) where the folder cannot be created.
  explicit PendingFile(std::filesystem::path path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Returns the path to write to: beside the final one, with the same extension. It is free, and to be made anew
  /// (O_EXCL): what somebody puts there meanwhile, a link say, is not written through.
  const std::filesystem::path& temporary_path() const { return temporary_; }
  const std::filesystem::path& path() const { return path_; }

  /// Renames the temporary file to its final name.
  /// Throws Error(kOutput) where that fails.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// Writes a file piece by piece; it appears on commit(), or not at all.
class AtomicFile {
 public:
  /// Throws Error(kOutput) where the file cannot be created.
  explicit AtomicFile(std::filesystem::path path);

  /// Throws Error(kOutput), for a full disk say.
  void write(std::string_view text);

  /// Closes the file and gives it its name.
  /// Throws Error(kOutput).
  void commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  PendingFile pending_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Writes a whole text file, or leaves what was there.
/// Throws Error(kOutput).
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Copies a file into a folder of the user's choice, in place of what was there.
/// Throws Error(kOutput), which names both and --out.
void copy_whole_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// The process that writes a temporary file. Machines that share a folder have processes of equal numbers.
struct Writer {
  std::string host;  ///< 8 hexadecimal digits, of the machine's name
  pid_t process = 0;
  bool operator==(const Writer&) const = default;
};

/// The name of this machine; empty where it has none.
std::string host_name();

/// This process.
Writer this_writer();

/// The path at which this process writes what will be `path`: beside it, with the same extension.
std::filesystem::path make_temporary_path(const std::filesystem::path& path);

/// The path of a hidden folder of this process, for work that is renamed out of it. `what` is "worker".
std::filesystem::path make_temporary_folder_path(const std::filesystem::path& folder, std::string_view what);

/// A folder that goes with its object.
class ScratchFolder {
 public:
  explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {}
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Whether a path is one of the two.
bool is_temporary(const std::filesystem::path& path);

/// Removes from a folder and the folders right in it what was written under those two names by writers that
/// `is_stale` picks. What cannot be listed or removed stays.
void remove_temporary_files(const std::filesystem::path& folder, const std::function<bool(const Writer&)>& is_stale);

/// Whether it was a process of this machine, and has ended. What other machines' processes do nobody can tell here.
bool is_gone(const Writer& writer);

inline constexpr std::uintmax_t kMebibyte = std::uintmax_t{1} << 20;

/// Throws, of this kind, where a path leads to a device, a pipe or a socket, which may have no end, or to a file of
/// more bytes than that. What does not exist, and what is a folder, is the caller's business.
void require_plain_file(const std::filesystem::path& file, std::uintmax_t most_bytes,
                        ErrorKind kind = ErrorKind::kInput);

/// Reads a whole file. Throws likewise, and where it is missing, a folder or unreadable.
std::vector<unsigned char> read_file_bytes(const std::filesystem::path& file,
                                           std::uintmax_t most_bytes = 4096 * kMebibyte,
                                           ErrorKind kind = ErrorKind::kInput);

/// Hashes bytes.
/// Source: Fowler, Noll and Vo, FNV-1a, 64 bits.
std::uint64_t hash_text(std::string_view text);

/// Makes a file stem of any name, so that the file stays in the report folder.
/// Returns letters, digits, '-', '_' and '.' only, at most 80 characters, not starting with '.' or '-'; a name that had
/// to be changed gets its hash appended, so that two names never share a file.
std::string make_file_stem(std::string_view name);

/// Percent-encodes a relative path with '/' between folders for use as a URL.
std::string encode_url_path(std::string_view path);

}  // namespace shadowbench
