#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "report/images/picture_io.h"

namespace shadowbench::measure {

/// Keeps traced images between runs, one EXR file for each, named by the content they follow from: geometry, receivers,
/// light, settings and the code that traced them. Files can be deleted at any time.
class TruthCache {
 public:
  /// An empty folder name keeps nothing. Clears away what killed processes left half-written. `note` hears, once, of a
  /// folder that cannot be written.
  TruthCache(std::filesystem::path folder, std::function<void(const std::string&)> note);

  /// Gives what was kept under a name; nothing where there is none, or where the file is damaged, of another content,
  /// or not what `is_wanted` says is wanted.
  std::optional<std::vector<images::Part>> load(
      const std::string& name,
      const std::function<bool(const std::vector<images::Part>&)>& is_wanted = [](const auto&) { return true; });

  /// Keeps parts of one channel under a name.
  void store(const std::string& name, const std::vector<images::Part>& parts);

  /// Deletes the files that were used longest ago until the folder holds at most `max_bytes`.
  void prune(std::uintmax_t max_bytes) const;

  int loaded() const { return loaded_; }  ///< images taken from the cache
  int traced() const { return traced_; }  ///< images that it did not hold

 private:
  std::filesystem::path folder_;
  std::function<void(const std::string&)> note_;
  int loaded_ = 0;
  int traced_ = 0;

  std::filesystem::path path_of(const std::string& name) const { return folder_ / (name + ".exr"); }
};

}  // namespace shadowbench::measure
