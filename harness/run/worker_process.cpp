#include "harness/run/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "filters/filter_spec.h"
#include "harness/live/frame_file.h"
#include "harness/options/experiment_file.h"
#include "harness/run/float_images.h"
#include "report/images/picture_io.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

using Clock = std::chrono::steady_clock;

/// What the new process does before it is the program; nothing here may take memory, which another thread may have
/// locked.
[[noreturn]] void become_worker(const char* program, char* const* words, int niceness, int error_write_end,
                                pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(EXIT_FAILURE);  // it had ended before that
  if (niceness > 0) setpriority(PRIO_PROCESS, 0, niceness);
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
  dup2(error_write_end, STDERR_FILENO);
  execv(program, words);
  constexpr std::string_view kMessage = "shadowbench: the program's own file cannot be started\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  _exit(EXIT_FAILURE);
}

/// The filter with the radius that the light's width gave, as a worker is told it.
filters::FilterRequest tell_radius(filters::FilterRequest request) {
  if (const std::string* name = request.param_by_light()) request.set_by_user.insert(*name);
  request.width.clear();
  return request;
}

/// An experiment of this one cell, for a worker that writes into `folder`.
options::RunOptions make_worker_options(const options::RunOptions& options, const measure::SceneTask& task,
                                        const filters::FilterRequest& request, const std::filesystem::path& folder) {
  options::RunOptions own = options;
  own.title.clear();
  own.scenes.clear();  // these are paths, which need not be text that a file can hold: they go with the words
  own.filter_files.clear();
  own.views = {task.camera->name};
  own.light_names = {task.scene->light.name};
  own.filters = {tell_radius(request)};
  own.kernel_width.clear();
  own.map_sizes = {task.map_size};
  own.equal_bytes = false;
  own.sizes = {{options.width, options.height}};
  own.fits = {options.fit};
  own.pad_texels = measure::padding_texels(options);
  own.border_page = false;
  own.truth = own.truth && own.frames > 1;
  own.out = folder;
  return own;
}

/// Gives a user's filter to a worker. Throws Error with its message where it refuses the filter or anything else.
WorkerOutcome run_filter_worker(const options::RunOptions& own, const filters::FilterRequest& request,
                                const WorkerScene& scene, const char* what) {
  const std::filesystem::path experiment = own.out / "experiment.toml";
  write_text_file(experiment, options::write_experiment(own));
  WorkerOutcome outcome =
      run_worker({"run", experiment.string(), what, "--scene=" + scene.argument, "--filter-file=" + request.spec.path,
                  "--gl", scene.backend, cache_word(own.cache), "--out", own.out.string()},
                 own.cell_timeout_s);
  const int code = outcome.exit_code.value_or(0);
  if (code == static_cast<int>(ErrorKind::kFilter))
    throw filters::FilterErrors({{request.spec.id, request.spec.path, clean_message(outcome.error_text)}});
  if (code >= static_cast<int>(ErrorKind::kUsage) && code <= static_cast<int>(ErrorKind::kOutput))
    throw Error(static_cast<ErrorKind>(code), clean_message(outcome.error_text));
  return outcome;
}

measure::MeasuredCell failed_cell(const options::RunOptions& options, const measure::SceneTask& task,
                                  const filters::FilterRequest& request, const WorkerOutcome& outcome) {
  measure::MeasuredCell cell;
  cell.record = measure::make_record(options, task, request);
  cell.request = request;
  cell.label = request.label();
  if (outcome.timed_out) {
    cell.record.status = records::CellStatus::kTimeout;
    cell.record.message = fmt::format("not finished after {:g} s (--cell-timeout)", options.cell_timeout_s);
  } else {
    cell.record.status = records::CellStatus::kCrashed;
    cell.record.message =
        outcome.signal
            ? fmt::format("killed by signal {} ({})", outcome.signal, strsignal(outcome.signal))
            : fmt::format("ended with exit code {}: {}", *outcome.exit_code, clean_message(outcome.error_text));
  }
  for (const char* group : {"time_ms", "ratio_to_none", "cost", "receivers", "nan", "stability", "images", "gpu"})
    cell.record.absent[group] = cell.record.message;
  return cell;
}

measure::MeasuredCell read_cell(const options::RunOptions& options, const measure::SceneTask& task,
                                const filters::FilterRequest& request) {
  const filters::FilterRequest told = tell_radius(request);
  const records::CellRecord planned = measure::make_record(options, task, request);
  measure::MeasuredCell cell;
  cell.request = request;
  cell.record = records::read_cell(options.out, measure::make_record(options, task, told).key);
  cell.record.key = planned.key;
  cell.record.kernel = planned.kernel;
  for (const char* field : {"kernel", "kernel.sigma_texels", "kernel.class"}) cell.record.absent.erase(field);
  cell.record.absent.insert(planned.absent.begin(), planned.absent.end());
  const std::optional<std::string> frames = cell.record.images.frames;
  cell.record.images = {};
  cell.record.images.frames = frames;
  cell.phases.resize(static_cast<std::size_t>(options.phases) - 1);
  images::ExrFile file = images::read_exr(options.out / exr_name(options, task));
  cell.label = told.label();
  take_float_images(cell, file.parts);
  cell.label = request.label();
  return cell;
}

void check_user_filter(const options::RunOptions& options, const measure::SceneTask& task,
                       const filters::FilterRequest& request, const WorkerScene& scene) {
  const ScratchFolder folder(make_temporary_folder_path(options.out, "worker"));
  run_filter_worker(make_worker_options(options, task, request, folder.path()), request, scene, "--check");
}

}  // namespace

WorkerProcess::WorkerProcess(const std::vector<std::string>& arguments, const WorkerSetup& setup) {
  std::vector<std::string> words = {"shadowbench"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw Error(ErrorKind::kOutput, fmt::format("cannot make a pipe for a process: {}", std::strerror(errno)));
  pipe_ = ends[0];
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) become_worker(setup.program.c_str(), argv.data(), setup.niceness, ends[1], parent);
  const int error = errno;
  close(ends[1]);
  if (process_ > 0) {
    setpgid(process_, process_);  // as it does itself, so that it can be killed at once
    return;
  }
  close(pipe_);
  throw Error(ErrorKind::kOutput, fmt::format("cannot start a process: {}", std::strerror(error)));
}

WorkerProcess::~WorkerProcess() {
  if (process_ > 0) end();
}

bool WorkerProcess::has_ended() const {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == process_;
}

/// The end of the pipe is no end of the process, which may have closed it; nor is it needed, where a child of it goes
/// on.
bool WorkerProcess::listen(Clock::time_point deadline) {
  constexpr std::int64_t kLongestWait_ms = 50;
  std::array<char, 4096> buffer;
  while (true) {
    const bool ended = has_ended();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    const auto wait = std::clamp<std::int64_t>(ended ? 0 : left, 0, pipe_ >= 0 ? kLongestWait_ms : 1);
    pollfd waiting{pipe_, POLLIN, 0};  // a pipe of -1 is left out
    const int ready = poll(&waiting, 1, static_cast<int>(wait));
    if (ready > 0) {
      const ssize_t got = read(pipe_, buffer.data(), buffer.size());
      if (got > 0) text_.append(buffer.data(), static_cast<std::size_t>(got));
      if (got == 0 || (got < 0 && errno != EINTR)) close(std::exchange(pipe_, -1));
    } else if (ended) {
      return true;
    } else if (left <= 0) {
      return false;
    }
  }
}

WorkerOutcome WorkerProcess::end() {
  const bool had_ended = has_ended();
  kill(-process_, SIGKILL);  // what it started goes, too
  if (pipe_ >= 0) close(std::exchange(pipe_, -1));
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  WorkerOutcome outcome{.error_text = text_};
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  if (WIFEXITED(status) && had_ended) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

std::string cache_word(const std::filesystem::path& cache) {
  return cache.empty() ? "--no-cache" : "--cache=" + cache.string();
}

std::string clean_message(const std::string& text) {
  const std::string prefix = "shadowbench: ";
  const std::size_t begin = text.find(prefix);
  std::string message = begin == std::string::npos ? text : text.substr(begin + prefix.size());
  while (!message.empty() && message.back() == '\n') message.pop_back();
  return message.empty() ? "no message" : message;
}

WorkerOutcome run_worker(const std::vector<std::string>& arguments, double timeout_s) {
  const auto deadline = Clock::now() + std::chrono::milliseconds(static_cast<std::int64_t>(timeout_s * 1000.0));
  WorkerProcess worker(arguments);
  const bool ended = worker.listen(deadline);
  WorkerOutcome outcome = worker.end();
  outcome.timed_out = !ended;
  return outcome;
}

measure::MeasuredCell measure_user_filter(const options::RunOptions& options, const measure::SceneTask& task,
                                          const filters::FilterRequest& request, const WorkerScene& scene) {
  const ScratchFolder folder(make_temporary_folder_path(options.out, "worker"));
  const options::RunOptions own = make_worker_options(options, task, request, folder.path());
  const WorkerOutcome outcome = run_filter_worker(own, request, scene, "--worker");
  if (outcome.exit_code != 0) return failed_cell(options, task, request, outcome);
  live::copy_frames(own.out, options.out);
  return read_cell(own, task, request);
}

void check_user_filters(const RunPlan& plan, const std::string& backend) {
  std::set<std::string> checked;  // ids
  std::vector<filters::FilterMistake> mistakes;
  for (const PlannedTask& planned : plan.tasks) {
    const PlannedScene& scene = plan.scenes[planned.scene];
    for (const filters::FilterRequest& request : planned.task.filters) {
      if (!request.user_file || !checked.insert(request.spec.id).second) continue;
      try {
        check_user_filter(scene.options, planned.task, request, {scene.argument, backend});
      } catch (const filters::FilterErrors& error) {
        mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
      }
    }
  }
  if (!mistakes.empty()) throw filters::FilterErrors(std::move(mistakes));
}

}  // namespace shadowbench::run
