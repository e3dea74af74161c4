#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "filters/base/error.h"
#include "harness/cli/commands.h"

namespace {

constexpr int kUsageError = 2;
constexpr int kInputError = static_cast<int>(shadowbench::ErrorKind::kInput);
constexpr int kOutputError = static_cast<int>(shadowbench::ErrorKind::kOutput);
constexpr int kBug = 70;

/// Control characters of names and files as "\x1b": they would steer the terminal. Lines of a shader's log stay lines.
std::string make_visible(const std::string& message) {
  std::string visible;
  for (const char c : message) {
    const auto code = static_cast<unsigned char>(c);
    visible += (code < 0x20 && c != '\n') || code == 0x7f ? fmt::format("\\x{:02x}", code) : std::string(1, c);
  }
  return visible;
}

/// One line for one failure; nothing else of the program prints errors.
void print_error(const std::string& message) { fmt::print(stderr, "shadowbench: {}\n", make_visible(message)); }

/// Runs what the command line asks for. Throws what main() turns into messages.
int run(int argc, char** argv) {
  CLI::App app("Compares soft-shadow filters: pictures, cost and error of each, over the same scenes.", "shadowbench");
  app.require_subcommand(1);
  shadowbench::cli::Action action;
  shadowbench::cli::add_run_command(app, action, {argv, argv + argc});
  shadowbench::cli::add_list_command(app, action);
  shadowbench::cli::add_diff_command(app, action);
  shadowbench::cli::add_bias_command(app, action);
  shadowbench::cli::add_merge_command(app, action);
  shadowbench::cli::add_advise_command(app, action);
  shadowbench::cli::add_tune_command(app, action);
  shadowbench::cli::add_stress_command(app, action, {argv, argv + argc});
  shadowbench::cli::add_regress_command(app, action, {argv, argv + argc});
  shadowbench::cli::add_flicker_command(app, action, {argv, argv + argc});
  try {
    app.parse(argc, argv);
    return action();
  } catch (const CLI::Success& help) {
    return app.exit(help);
  }
}

/// What was printed may not have got anywhere: a disk is full, a pipe is closed.
int finish_output(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  print_error(
      fmt::format("standard output cannot be written ({}); check the free space where it goes", std::strerror(errno)));
  return kOutputError;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is an error of the write, as a full disk is
  try {
    return finish_output(run(argc, argv));
  } catch (const CLI::ParseError& error) {
    print_error(fmt::format("{}; see 'shadowbench --help'", error.what()));
    return kUsageError;
  } catch (const shadowbench::Error& error) {
    print_error(error.what());
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    print_error(
        "memory ran out; raise the limit (ulimit -v), or choose a smaller --size, a smaller --map-size or fewer "
        "filters at once");
    return kInputError;
  } catch (const std::system_error& error) {
    print_error(fmt::format("{}; check that the folder is there, its rights and its free space", error.what()));
    return kOutputError;
  } catch (const std::exception& error) {
    print_error(fmt::format("bug: {}; please report it with the command line", error.what()));
    return kBug;
  }
}
