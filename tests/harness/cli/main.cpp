#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "harness/cli/commands.h"

/// The tests, or the program itself where its words follow: a run starts itself anew for what may crash. Mesa asks but
/// once where compiled shaders go, which is not to be the folder of the first test.
int main(int argc, char** argv) {
  if (argc > 1 && argv[1][0] != '-') return shadowbench::cli::run_program({argv, argv + argc});
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  setenv("MESA_SHADER_CACHE_DIR", (folder / "shaders").c_str(), 0);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
