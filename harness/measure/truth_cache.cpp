#include "harness/measure/truth_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <system_error>

#include "filters/base/error.h"
#include "harness/measure/content_hash.h"
#include "report/files/temporary_files.h"

namespace shadowbench::measure {
namespace {

constexpr const char* kName = "shadowbench:truth";
constexpr const char* kChecksum = "shadowbench:checksum";

std::string checksum(const std::vector<images::Part>& parts) {
  ContentHash hash;
  for (const images::Part& part : parts) {
    hash.add(fmt::format("{} {}x{}", part.name, part.image.width, part.image.height));
    hash.add_values(std::span<const float>(part.image.texels));
  }
  return hash.name();
}

bool holds(const images::ExrFile& file, const char* attribute, const std::string& text) {
  const auto found = file.metadata.find(attribute);
  if (found == file.metadata.end()) return false;
  const auto* value = std::get_if<std::string>(&found->second);
  return value && *value == text;
}

}  // namespace

TruthCache::TruthCache(std::filesystem::path folder, std::function<void(const std::string&)> note)
    : folder_(std::move(folder)), note_(std::move(note)) {
  if (!folder_.empty()) files::remove_temporary_files(folder_, files::is_gone);
}

std::optional<std::vector<images::Part>> TruthCache::load(
    const std::string& name, const std::function<bool(const std::vector<images::Part>&)>& is_wanted) {
  std::error_code error;
  if (!folder_.empty() && std::filesystem::is_regular_file(path_of(name), error)) {
    try {
      images::ExrFile file = images::read_exr(path_of(name));
      if (holds(file, kName, name) && holds(file, kChecksum, checksum(file.parts)) && is_wanted(file.parts)) {
        std::filesystem::last_write_time(path_of(name), std::filesystem::file_time_type::clock::now(), error);
        ++loaded_;
        return std::move(file.parts);
      }
    } catch (const std::exception&) {
      // Damaged, whatever its header made of it: traced again and written anew.
    }
  }
  ++traced_;
  return std::nullopt;
}

void TruthCache::store(const std::string& name, const std::vector<images::Part>& parts) {
  if (folder_.empty() || !note_) return;
  try {
    images::write_exr(path_of(name), parts, {{kName, name}, {kChecksum, checksum(parts)}});
  } catch (const Error& error) {
    note_(fmt::format("traced images are not kept for the next run: {}; choose another folder with --cache",
                      error.what()));
    note_ = nullptr;  // one that cannot be written may still be read
  }
}

void TruthCache::prune(std::uintmax_t max_bytes) const {
  struct Entry {
    std::filesystem::path path;
    std::filesystem::file_time_type used;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code error;
  std::filesystem::directory_iterator file(folder_, error);
  for (; !error && file != std::filesystem::directory_iterator(); file.increment(error)) {
    if (file->path().extension() != ".exr") continue;
    std::error_code gone;
    const Entry entry{file->path(), file->last_write_time(gone), file->file_size(gone)};
    if (gone) continue;
    total += entry.bytes;
    entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (total <= max_bytes) return;
    if (std::filesystem::remove(entry.path, error)) total -= entry.bytes;
  }
}

}  // namespace shadowbench::measure
