#include "base/files.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "base/error.h"

namespace shadowbench {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code) {
  throw Error(ErrorKind::kOutput,
              fmt::format("{} ({}); check the folder's rights and free space, or choose another with --out", what,
                          std::generic_category().message(code)),
              path.string());
}

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

constexpr std::size_t kMaxStem = 80;

bool is_portable(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path path) : path_(std::move(path)), temporary_(make_temporary_path(path_)) {
  std::error_code error;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
  if (error) fail(path_.parent_path(), "the folder cannot be created", error.value());
  std::filesystem::remove(temporary_, error);  // a link of that name would be written through
}

PendingFile::~PendingFile() {
  if (!committed_) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
}

void PendingFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error == std::errc::no_such_file_or_directory) {
    throw Error(ErrorKind::kOutput,
                "its folder was removed or replaced while the file was written; run the same command again, or choose "
                "another with --out",
                path_.string());
  }
  if (error) fail(path_, "the file cannot be given its name", error.value());
  committed_ = true;
}

AtomicFile::AtomicFile(std::filesystem::path path)
    : pending_(std::move(path)), file_(std::fopen(pending_.temporary_path().c_str(), "wbx")) {
  if (!file_) fail(pending_.path(), "the file cannot be created", errno);
}

void AtomicFile::write(std::string_view text) {
  assert(file_);
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size())
    fail(pending_.path(), "the file cannot be written", errno);
}

void AtomicFile::commit() {
  if (std::fclose(file_.release()) != 0) fail(pending_.path(), "the file cannot be written", errno);
  pending_.commit();
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

void copy_whole_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  PendingFile pending(to);
  std::error_code error;
  std::filesystem::copy_file(from, pending.temporary_path(), error);
  if (error)
    throw Error(
        ErrorKind::kOutput,
        fmt::format(
            "it cannot be copied to {} ({}); check rights and free space there, or choose another folder with --out",
            to.string(), error.message()),
        from.string());
  pending.commit();
}

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

void require_plain_file(const std::filesystem::path& file, std::uintmax_t most_bytes, ErrorKind kind) {
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (failure || !exists(status) || is_directory(status)) return;
  if (!is_regular_file(status))
    throw Error(kind, "this is a device, a pipe or a socket: name a file, into which it may be copied first",
                file.string());
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  if (failure || bytes <= most_bytes) return;
  throw Error(kind,
              fmt::format("it has {} MiB, and {} MiB are the most that are read here", bytes / kMebibyte,
                          most_bytes / kMebibyte),
              file.string());
}

std::vector<unsigned char> read_file_bytes(const std::filesystem::path& file, std::uintmax_t most_bytes,
                                           ErrorKind kind) {
  const auto fail = [&](const std::string& message) { throw Error(kind, message, file.string()); };
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(file, failure);
  if (!exists(status)) fail("there is no such file");
  if (is_directory(status)) fail("this is not a file");
  require_plain_file(file, most_bytes, kind);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(std::string("cannot be opened: ") + std::strerror(errno));
  std::vector<unsigned char> bytes(static_cast<std::size_t>(std::filesystem::file_size(file)));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) fail("cannot be read to its end");
  return bytes;
}

std::uint64_t hash_text(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  return hash;
}

std::string make_file_stem(std::string_view name) {
  const bool starts_plainly = !name.empty() && name.front() != '.' && name.front() != '-';
  std::string stem(starts_plainly ? "" : "_");
  stem += name;
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return !is_portable(c); }, '_');
  if (stem == name && stem.size() <= kMaxStem) return stem;
  const std::string suffix = fmt::format("-{:016x}", hash_text(name));
  return stem.substr(0, kMaxStem - suffix.size()) + suffix;
}

std::string encode_url_path(std::string_view path) {
  std::string url;
  for (const char c : path)
    if (is_portable(c) || c == '/')
      url += c;
    else
      url += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return url;
}

}  // namespace shadowbench
