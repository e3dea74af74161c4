#include "harness/view/file_watch.h"

#include <system_error>

namespace shadowbench::view {

FileWatch::Stamp FileWatch::read_stamp(const std::filesystem::path& file) {
  std::error_code missing;
  Stamp stamp;
  stamp.written = std::filesystem::last_write_time(file, missing);
  if (!missing) stamp.bytes = std::filesystem::file_size(file, missing);
  stamp.is_there = !missing;
  return stamp.is_there ? stamp : Stamp();
}

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
  std::map<std::filesystem::path, Stamp> watched;
  for (const std::filesystem::path& file : files) {
    const auto known = files_.find(file);
    watched[file] = known != files_.end() ? known->second : read_stamp(file);
  }
  files_ = std::move(watched);
}

bool FileWatch::has_changed() {
  bool changed = false;
  for (auto& [file, stamp] : files_) {
    const Stamp now = read_stamp(file);
    // An editor that replaces a file leaves none for a moment: what is not there yet is no change.
    if (!now.is_there || now == stamp) continue;
    stamp = now;
    changed = true;
  }
  return changed;
}

}  // namespace shadowbench::view
