#pragma once

#include <filesystem>

#include "base/error.h"

namespace shadowbench {

/// Refuses a folder that has a link at any level: what is read or written through one lies elsewhere.
void require_no_links(const std::filesystem::path& folder, ErrorKind kind);

/// Keeps an output folder for this process, so that two runs never write into one, and removes what killed runs
/// left half-written. The system lets go of the lock of a process that ends, however it ends.
class FolderLock {
 public:
  /// Creates the folder where it is missing, and takes it, or refuses at once where another process has it, where it
  /// holds links, or files that this program did not write, unless it `takes_any`. A new folder is marked as ours.
  /// Throws Error(kOutput), which names the folder, and the other process.
  explicit FolderLock(std::filesystem::path folder, bool takes_any = false);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Checks that the folder is still the one that was taken.
  /// Throws Error(kOutput) where it was removed, renamed or replaced meanwhile.
  void require_in_place() const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;
  int descriptor_ = -1;

  bool try_to_take();
  bool is_in_place() const;
};

}  // namespace shadowbench
