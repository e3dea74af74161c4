#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace shadowbench::view {

/// Sees when files are saved, by looking at them.
class FileWatch {
 public:
  /// Looks at these files from now on; those it looks at already go on to count from what they were.
  void watch(const std::vector<std::filesystem::path>& files);

  /// Whether any has changed since it was last asked: written, replaced, or come back after it was gone.
  bool has_changed();

 private:
  /// What tells a file's states apart; two saves within a clock's tick differ in size or in their inode, mostly.
  struct Stamp {
    std::filesystem::file_time_type written{};
    std::uintmax_t bytes = 0;
    bool is_there = false;
    bool operator==(const Stamp&) const = default;
  };

  std::map<std::filesystem::path, Stamp> files_;

  static Stamp read_stamp(const std::filesystem::path& file);
};

}  // namespace shadowbench::view
