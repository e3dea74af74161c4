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
#include <string>
#include <vector>

extern char** environ;

namespace shadowbench::bench {
namespace {

/// Runs the program and gives its peak memory in MiB, or a negative number when it failed.
double run_program(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SHADOWBENCH_PROGRAM);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = -1;
  const int failed = posix_spawn(&pid, SHADOWBENCH_PROGRAM, &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  int status = 0;
  rusage usage{};
  if (failed || wait4(pid, &status, 0, &usage) != pid || status != 0) return -1.0;
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void list_filters(benchmark::State& state) {
  for (auto _ : state)
    if (run_program({"list", "filters"}) < 0.0) state.SkipWithError("the program failed");
}
BENCHMARK(list_filters)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The default run, first with nothing traced before, then with all of it in the cache.
void default_run(benchmark::State& state) {
  const auto folder = std::filesystem::temp_directory_path() / ("shadowbench_bench." + std::to_string(getpid()));
  const std::vector<std::string> arguments = {"run", "--out", folder.string(), "--cache", (folder / "cache").string()};
  double peak_mib = 0.0;
  for (auto _ : state) {
    for (const char* counter : {"cold_s", "warm_s"}) {
      const auto begin = std::chrono::steady_clock::now();
      const double used = run_program(arguments);
      if (used < 0.0) state.SkipWithError("the program failed");
      state.counters[counter] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      peak_mib = std::max(peak_mib, used);
    }
  }
  state.counters["peak_MiB"] = peak_mib;
  std::filesystem::remove_all(folder);
}
BENCHMARK(default_run)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);

}  // namespace
}  // namespace shadowbench::bench
