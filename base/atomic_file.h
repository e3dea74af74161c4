#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

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

}  // namespace shadowbench
