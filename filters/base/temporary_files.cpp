#include "filters/base/temporary_files.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace shadowbench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFileMark = ".shadowbench-tmp-";
constexpr std::string_view kFolderMarks[] = {".worker-"};

/// Reads the number at the beginning of a text; nothing where other characters follow than `end`.
std::optional<pid_t> parse_process(std::string_view text, std::string_view end) {
  pid_t process = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), process);
  const std::string_view rest(last, static_cast<std::size_t>(text.data() + text.size() - last));
  if (error != std::errc() || process <= 0 || rest != end) return std::nullopt;
  return process;
}

/// The number of the process that a temporary file belongs to; nothing where it is no temporary file.
std::optional<pid_t> owner_of_file(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t mark = name.rfind(kFileMark);
  if (mark == std::string::npos) return std::nullopt;
  return parse_process(std::string_view(name).substr(mark + kFileMark.size()),
                       path.extension().string().starts_with(kFileMark) ? "" : path.extension().string());
}

std::optional<pid_t> owner_of_folder(const fs::path& path) {
  const std::string name = path.filename().string();
  for (const std::string_view mark : kFolderMarks)
    if (name.starts_with(mark)) return parse_process(std::string_view(name).substr(mark.size()), "");
  return std::nullopt;
}

/// Removes the stale entries of one folder, and gives its folders that are not stale.
std::vector<fs::path> clean(const fs::path& folder, const std::function<bool(pid_t)>& is_stale) {
  std::vector<fs::path> stale, folders;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
    const bool is_folder = entry->symlink_status(unknown).type() == fs::file_type::directory;
    const std::optional<pid_t> owner = is_folder ? owner_of_folder(entry->path()) : owner_of_file(entry->path());
    if (owner && is_stale(*owner))
      stale.push_back(entry->path());
    else if (is_folder)
      folders.push_back(entry->path());
  }
  for (const fs::path& path : stale) fs::remove_all(path, error);
  return folders;
}

}  // namespace

fs::path make_temporary_path(const fs::path& path) {
  fs::path name = path.stem();
  name += fmt::format("{}{}", kFileMark, getpid());
  name += path.extension();
  return path.parent_path() / name;
}

fs::path make_temporary_folder_path(const fs::path& folder, std::string_view what) {
  return folder / fmt::format(".{}-{}", what, getpid());
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

bool is_temporary(const fs::path& path) { return owner_of_file(path) || owner_of_folder(path); }

void remove_temporary_files(const fs::path& folder, const std::function<bool(pid_t)>& is_stale) {
  for (const fs::path& inner : clean(folder, is_stale)) clean(inner, is_stale);
}

bool is_gone(pid_t process) { return kill(process, 0) != 0 && errno == ESRCH; }

}  // namespace shadowbench
