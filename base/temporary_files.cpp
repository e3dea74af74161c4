#include "base/temporary_files.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "base/content_hash.h"

namespace shadowbench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFileMark = ".shadowbench-tmp-";
constexpr std::string_view kFolderMarks[] = {".worker-", ".gpu-"};

std::string name_of(const Writer& writer) { return fmt::format("{}-{}", writer.process, writer.host); }

/// Reads name_of() at the beginning of a text; nothing where other characters follow than `end`. Versions of before
/// wrote the number alone.
std::optional<Writer> parse_writer(std::string_view text, std::string_view end) {
  Writer writer = this_writer();
  if (!text.ends_with(end)) return std::nullopt;
  text.remove_suffix(end.size());
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), writer.process);
  const std::string_view rest(last, static_cast<std::size_t>(text.data() + text.size() - last));
  if (error != std::errc() || writer.process <= 0) return std::nullopt;
  if (rest.starts_with('-'))
    writer.host = rest.substr(1);
  else if (!rest.empty())
    return std::nullopt;
  return writer;
}

/// The writer of a temporary file; nothing where it is no temporary file.
std::optional<Writer> writer_of_file(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t mark = name.rfind(kFileMark);
  if (mark == std::string::npos) return std::nullopt;
  return parse_writer(std::string_view(name).substr(mark + kFileMark.size()),
                      path.extension().string().starts_with(kFileMark) ? "" : path.extension().string());
}

std::optional<Writer> writer_of_folder(const fs::path& path) {
  const std::string name = path.filename().string();
  for (const std::string_view mark : kFolderMarks)
    if (name.starts_with(mark)) return parse_writer(std::string_view(name).substr(mark.size()), "");
  return std::nullopt;
}

/// Removes the stale entries of one folder, and gives its folders that are not stale.
std::vector<fs::path> clean(const fs::path& folder, const std::function<bool(const Writer&)>& is_stale) {
  std::vector<fs::path> stale, folders;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
    const bool is_folder = entry->symlink_status(unknown).type() == fs::file_type::directory;
    const std::optional<Writer> writer = is_folder ? writer_of_folder(entry->path()) : writer_of_file(entry->path());
    if (writer && is_stale(*writer))
      stale.push_back(entry->path());
    else if (is_folder)
      folders.push_back(entry->path());
  }
  for (const fs::path& path : stale) fs::remove_all(path, error);
  return folders;
}

}  // namespace

std::string host_name() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

Writer this_writer() {
  static const std::string host = [] {
    ContentHash hash;
    hash.add(host_name());
    return hash.name().substr(0, 8);
  }();
  return {host, getpid()};
}

fs::path make_temporary_path(const fs::path& path) {
  fs::path name = path.stem();
  name += fmt::format("{}{}", kFileMark, name_of(this_writer()));
  name += path.extension();
  return path.parent_path() / name;
}

fs::path make_temporary_folder_path(const fs::path& folder, std::string_view what) {
  return folder / fmt::format(".{}-{}", what, name_of(this_writer()));
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

bool is_temporary(const fs::path& path) { return writer_of_file(path) || writer_of_folder(path); }

void remove_temporary_files(const fs::path& folder, const std::function<bool(const Writer&)>& is_stale) {
  for (const fs::path& inner : clean(folder, is_stale)) clean(inner, is_stale);
}

bool is_gone(const Writer& writer) {
  return writer.host == this_writer().host && kill(writer.process, 0) != 0 && errno == ESRCH;
}

}  // namespace shadowbench
