#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::truth {

/// What was traced for one view, as numbers of equal count for each layer.
using Layers = std::vector<std::vector<float>>;

/// What a run leaves of its cache, for prune(); the truths of a default run take some 15 MiB.
inline constexpr std::uintmax_t kMaxCacheBytes = std::uintmax_t{1} << 30;

/// Keeps what was traced between runs, one file each, named by all that the result depends on: geometry, receivers,
/// light, settings and the code that traces. The files can be deleted at any time.
class TruthCache {
 public:
  /// With an empty folder name nothing is kept. In a folder that holds other files, nothing is ever deleted; in one of
  /// our own, what killed processes left half-written is. `note` is called once if the folder cannot be written.
  TruthCache(std::filesystem::path folder, std::function<void(const std::string&)> note);

  /// Returns what was kept under a name, or nothing if there is no file, or one that is damaged, of another name, or of
  /// another size than `layers` times `values`.
  std::optional<Layers> load(const std::string& name, std::size_t layers, std::size_t values);

  void store(const std::string& name, const Layers& layers);

  /// Whether something is kept under a name; nobody reads whether it is whole.
  bool has(const std::string& name) const;

  /// Deletes the files that were used longest ago until the folder holds at most `max_bytes`: no others than this class
  /// wrote, and in a folder of our own.
  void prune(std::uintmax_t max_bytes) const;

  int loaded() const { return loaded_; }  ///< how often load() found what it was asked for
  int traced() const { return traced_; }  ///< how often it did not

 private:
  std::filesystem::path folder_;
  bool is_ours_;
  std::function<void(const std::string&)> note_;
  int loaded_ = 0;
  int traced_ = 0;

  std::filesystem::path path_of(const std::string& name) const { return folder_ / (name + ".truth"); }
};

}  // namespace shadowbench::truth
