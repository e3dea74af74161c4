#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace shadowbench {

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

}  // namespace shadowbench
