#include "harness/submit/sign_of_life.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/temporary_files.h"

namespace shadowbench::submit {
namespace {

namespace fs = std::filesystem;

std::string read_environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// Who runs the task: a line for read_last_sign(), and one for people.
std::string describe_runner() {
  const Writer own = this_writer();
  std::string text = fmt::format("{} {}\nprocess {} on {}", own.process, own.host, own.process, host_name());
  if (const std::string job = read_environment("SLURM_JOB_ID"); !job.empty())
    text += fmt::format(", job {}, node {}", job, read_environment("SLURMD_NODENAME"));
  return text + "\n";
}

}  // namespace

SignOfLife::SignOfLife(fs::path folder, std::chrono::milliseconds beat)
    : file_(std::move(folder) / kSignOfLife), beat_(beat) {
  write_text_file(file_, describe_runner());
  thread_ = std::thread([this] { keep_beating(); });
}

SignOfLife::~SignOfLife() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  thread_.join();
  remove_sign_of_life(file_.parent_path());
}

void SignOfLife::keep_beating() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, beat_, [this] { return ending_; })) {
    if (utimensat(AT_FDCWD, file_.c_str(), nullptr, 0) == 0) continue;  // without a time: the file system's own
    try {
      write_text_file(file_, describe_runner());  // another process that did the same task has taken it away
    } catch (const Error&) {
      // A full disk ends the task where it matters.
    }
  }
}

void remove_sign_of_life(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / kSignOfLife, ignored);
}

std::optional<LastSign> read_last_sign(const fs::path& folder, fs::file_time_type now) {
  std::error_code error;
  const fs::file_time_type last = fs::last_write_time(folder / kSignOfLife, error);
  if (error || !fs::is_regular_file(folder / kSignOfLife)) return std::nullopt;
  Writer writer;
  std::ifstream(folder / kSignOfLife) >> writer.process >> writer.host;
  return LastSign{std::chrono::duration<double>(now - last).count(), writer.process > 0 && is_gone(writer)};
}

fs::file_time_type file_system_now(const fs::path& folder) {
  const fs::path probe = make_temporary_path(folder / "now");
  std::error_code error;
  fs::remove(probe, error);  // a link of that name would be written through
  std::ofstream(probe) << "now";
  const fs::file_time_type now = fs::last_write_time(probe, error);
  std::error_code ignored;
  fs::remove(probe, ignored);
  return error ? fs::file_time_type::clock::now() : now;
}

}  // namespace shadowbench::submit
