#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace shadowbench::cli {

/// What a chosen subcommand does; gives the exit code.
using Action = std::function<int()>;

/// Adds `run`; on parsing, `action` is set to what it does. `words` is the whole command line, for the record.
void add_run_command(CLI::App& app, Action& action, const std::vector<std::string>& words);

/// Adds `list filters|scenes|metrics|gl`.
void add_list_command(CLI::App& app, Action& action);

/// Adds `diff`.
void add_diff_command(CLI::App& app, Action& action);

/// Adds `bias`.
void add_bias_command(CLI::App& app, Action& action);

/// Adds `regress`; `words` as for `run`.
void add_regress_command(CLI::App& app, Action& action, const std::vector<std::string>& words);

/// Adds `merge`.
void add_merge_command(CLI::App& app, Action& action);

/// Adds `advise`.
void add_advise_command(CLI::App& app, Action& action);

/// Adds `tune`.
void add_tune_command(CLI::App& app, Action& action);

/// Adds `stress`; `words` as for `run`.
void add_stress_command(CLI::App& app, Action& action, const std::vector<std::string>& words);

/// Adds `flicker`; `words` as for `run`.
void add_flicker_command(CLI::App& app, Action& action, const std::vector<std::string>& words);

}  // namespace shadowbench::cli
