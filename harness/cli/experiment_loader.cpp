#include "harness/cli/experiment_loader.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "filters/error.h"

namespace shadowbench::cli {

void load_and_run_experiment(const run::RunOptions& options, run::Progress& progress) {
  const auto module = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "shadowbench_experiment.so";
  // Never closed: exceptions and GL drivers keep pointers into it.
  void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* entry = handle ? dlsym(handle, "shadowbench_run_experiment") : nullptr;
  if (!entry) throw Error(ErrorKind::kUsage, fmt::format("cannot load a part of the program: {}; build it again", dlerror()));
  reinterpret_cast<void (*)(const run::RunOptions&, run::Progress&)>(entry)(options, progress);
}

}  // namespace shadowbench::cli
