// What the whole program costs, as a user starts it.

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "report/pages/write_page.h"
#include "report/records/json_io.h"

extern char** environ;

namespace shadowbench::bench {
namespace {

/// Waits for a process and gives its peak memory in MiB, or a negative number when it failed.
double wait_for(pid_t pid) {
  int status = 0;
  rusage usage{};
  if (wait4(pid, &status, 0, &usage) != pid || status != 0) return -1.0;
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Runs a command, whose first word is the program's path or name, as `wait_for` does.
double run_command(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = -1;
  const int failed = posix_spawnp(&pid, argv.front(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return failed ? -1.0 : wait_for(pid);
}

double run_program(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SHADOWBENCH_PROGRAM);
  return run_command(std::move(arguments));
}

/// A folder that goes when the benchmark does.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("shadowbench_bench." + std::to_string(getpid()));
  ~Folder() { std::filesystem::remove_all(path); }
};

double count_seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

void list_filters(benchmark::State& state) {
  for (auto _ : state)
    if (run_program({"list", "filters"}) < 0.0) state.SkipWithError("the program failed");
}
BENCHMARK(list_filters)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The default run, first with nothing traced before, then with all of it in the cache.
void default_run(benchmark::State& state) {
  const Folder folder;
  const std::vector<std::string> arguments = {"run", "--out", folder.path.string(), "--cache",
                                              (folder.path / "cache").string()};
  double peak_mib = 0.0;
  for (auto _ : state) {
    for (const char* counter : {"cold_s", "warm_s"}) {
      const auto begin = std::chrono::steady_clock::now();
      const double used = run_program(arguments);
      if (used < 0.0) state.SkipWithError("the program failed");
      state.counters[counter] = count_seconds(begin);
      peak_mib = std::max(peak_mib, used);
    }
  }
  state.counters["peak_MiB"] = peak_mib;
}
BENCHMARK(default_run)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);

/// Writes the report of a finished folder anew, in a process of its own. Returns its peak memory in MiB, or a negative
/// number when it failed.
double write_report_of(const std::filesystem::path& folder) {
  const pid_t pid = fork();
  if (pid != 0) return wait_for(pid);
  std::optional<records::Results> results = records::read_results(folder / "results.json");
  const records::RunRecord run = std::move(results->run);
  std::vector<std::string> keys;
  for (const records::CellRecord& cell : results->cells) keys.push_back(cell.key);
  results.reset();
  pages::write_report(folder, run, keys);
  _exit(0);
}

/// A sweep of so many cells in four shards: merged with its pictures, and its report alone.
void merge_cells(benchmark::State& state) {
  const Folder folder;
  const std::string shard = (folder.path / "shard").string(), whole = (folder.path / "whole").string();
  if (run_command({"python3", SHADOWBENCH_SOURCE_DIR "/tests/cluster/many_cells.py", "--program", SHADOWBENCH_PROGRAM,
                   "--cells", std::to_string(state.range(0)), "--out", folder.path.string()}) < 0.0)
    state.SkipWithError("the sweep could not be made");
  for (auto _ : state) {
    auto begin = std::chrono::steady_clock::now();
    const double merging = run_program({"merge", shard + "1", shard + "2", shard + "3", shard + "4", "--out", whole});
    state.counters["merge_s"] = count_seconds(begin);
    state.counters["merge_MiB"] = merging;
    begin = std::chrono::steady_clock::now();
    const double reporting = merging < 0.0 ? merging : write_report_of(whole);
    state.counters["report_s"] = count_seconds(begin);
    state.counters["report_MiB"] = reporting;
    if (reporting < 0.0) state.SkipWithError("the program failed");
  }
  std::error_code ignored;
  const auto page = std::filesystem::file_size(std::filesystem::path(whole) / "index.html", ignored);
  state.counters["page_MiB"] = static_cast<double>(page) / 1048576.0;
}
BENCHMARK(merge_cells)->Arg(1000)->Arg(10000)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);

}  // namespace
}  // namespace shadowbench::bench
