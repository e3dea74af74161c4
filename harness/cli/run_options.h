#pragma once

#include <string>
#include <vector>

#include "harness/cli/run_arguments.h"
#include "harness/options/options.h"

namespace shadowbench::cli {

/// Checks what the command line says of a run, and makes its options of it; `words` are kept for the record.
/// Throws Error(kUsage) with the option's name, and Error for a filter's file.
options::RunOptions make_run_options(const RunArguments& arguments, std::vector<std::string> words);

}  // namespace shadowbench::cli
