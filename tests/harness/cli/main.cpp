#include <gtest/gtest.h>

#include "harness/cli/program.h"

/// The tests, or the program itself where its words follow: a run starts itself anew for what may crash.
int main(int argc, char** argv) {
  if (argc > 1 && argv[1][0] != '-') return shadowbench::cli::run_program({argv, argv + argc});
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
