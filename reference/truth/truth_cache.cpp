#include "reference/truth/truth_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>

#include "base/atomic_file.h"
#include "base/compression.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/temporary_files.h"

namespace shadowbench::truth {
namespace {

constexpr std::uintmax_t kMostHeaderBytes = 65536;
constexpr int kCompression = 4;  // smaller than 1, and no slower

constexpr std::string_view kMark = "shadowbench truth ";
constexpr const char* kTag = "CACHEDIR.TAG";
/// Source: Cache Directory Tagging Specification 0.6; backups leave out a folder that has it.
constexpr std::string_view kTagText = "Signature: 8a477f597d28d172789f06886806bc55\n# Made by shadowbench\n";

/// Whether it is a file, and no link to one, that begins so.
bool begins_with(const std::filesystem::path& path, std::string_view text) {
  std::error_code error;
  if (std::filesystem::symlink_status(path, error).type() != std::filesystem::file_type::regular) return false;
  std::string head(text.size(), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == text;
}

bool is_truth(const std::filesystem::path& path) { return path.extension() == ".truth" && begins_with(path, kMark); }

/// Whether this program made the folder: it has our tag, or nothing but what is ours, as versions of before left it.
bool is_ours(const std::filesystem::path& folder) {
  if (begins_with(folder / kTag, kTagText)) return true;
  std::error_code error;
  for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end; file.increment(error))
    if (!is_truth(*file) && !is_temporary(*file) && file->path().filename() != "gpu") return false;
  return true;
}

/// A file is this line, then all layers as floats, compressed with zlib.
std::string make_header(const std::string& name, const std::vector<float>& values, std::size_t layers) {
  ContentHash checksum;
  checksum.add_values(std::span<const float>(values));
  return fmt::format("{}1 {} {}x{} {}\n", kMark, name, layers, values.size(), checksum.name());
}

/// Gives nothing for what is no file, or one of more bytes than that.
std::optional<std::string> read_whole_file(const std::filesystem::path& path, std::uintmax_t most_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) > most_bytes)
    return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// Returns all layers one after the other; nothing if the file is damaged or holds something else.
std::optional<std::vector<float>> read_values(const std::filesystem::path& path, const std::string& name,
                                              std::size_t layers, std::size_t values) {
  const std::uintmax_t packed_bytes = bound_compressed(layers * values * sizeof(float));
  const std::optional<std::string> file = read_whole_file(path, packed_bytes + kMostHeaderBytes);
  if (!file) return std::nullopt;
  const std::size_t begin = std::min(file->find('\n'), file->size() - 1) + 1;
  std::vector<float> all(layers * values);
  const auto packed = std::as_bytes(std::span(*file)).subspan(begin);
  const bool is_whole = decompress_bytes(packed, std::as_writable_bytes(std::span(all))) &&
                        file->starts_with(make_header(name, all, layers));
  return is_whole ? std::optional(std::move(all)) : std::nullopt;
}

void write_layers(const std::filesystem::path& path, const std::string& name, const Layers& layers) {
  std::vector<float> all;
  for (const std::vector<float>& layer : layers) all.insert(all.end(), layer.begin(), layer.end());
  AtomicFile file(path);
  file.write(make_header(name, all, layers.size()));
  file.write(compress_bytes(std::as_bytes(std::span(all)), kCompression));
  file.commit();
}

}  // namespace

TruthCache::TruthCache(std::filesystem::path folder, std::function<void(const std::string&)> note)
    : folder_(std::move(folder)), is_ours_(!folder_.empty() && truth::is_ours(folder_)), note_(std::move(note)) {
  if (is_ours_) remove_temporary_files(folder_, is_gone);
}

std::optional<Layers> TruthCache::load(const std::string& name, std::size_t layers, std::size_t values) {
  std::error_code error;
  std::optional<std::vector<float>> all;
  if (!folder_.empty()) all = read_values(path_of(name), name, layers, values);
  if (!all) {
    ++traced_;
    return std::nullopt;
  }
  std::filesystem::last_write_time(path_of(name), std::filesystem::file_time_type::clock::now(), error);
  ++loaded_;
  Layers found;
  for (std::size_t i = 0; i < layers; ++i) {
    const auto begin = all->begin() + static_cast<std::ptrdiff_t>(i * values);
    found.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(values));
  }
  return found;
}

void TruthCache::store(const std::string& name, const Layers& layers) {
  if (folder_.empty() || !note_) return;
  try {
    if (is_ours_ && !std::filesystem::exists(folder_ / kTag)) write_text_file(folder_ / kTag, kTagText);
    write_layers(path_of(name), name, layers);
  } catch (const Error& error) {
    note_(fmt::format("traced images are not kept for the next run: {}; choose another folder with --cache",
                      error.what()));
    note_ = nullptr;  // nothing more is written, but what the folder holds is still read
  }
}

bool TruthCache::has(const std::string& name) const {
  std::error_code ignored;
  return !folder_.empty() && std::filesystem::is_regular_file(path_of(name), ignored);
}

void TruthCache::prune(std::uintmax_t max_bytes) const {
  if (!is_ours_) return;
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
    if (!is_truth(*file)) continue;
    std::error_code gone;
    const Entry entry{file->path(), file->last_write_time(gone), file->file_size(gone)};
    if (gone) continue;
    total += entry.bytes;
    entries.push_back(entry);
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (total <= max_bytes) return;
    if (std::filesystem::remove(entry.path, error)) total -= entry.bytes;
  }
}

}  // namespace shadowbench::truth
