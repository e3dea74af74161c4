#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "base/error.h"
#include "harness/cli/commands.h"
#include "harness/cli/terminal.h"

namespace shadowbench::cli {
namespace {

constexpr int kInputError = static_cast<int>(ErrorKind::kInput);
constexpr int kOutputError = static_cast<int>(ErrorKind::kOutput);
constexpr int kBug = 70;

/// Does what the command line asks for. Throws what run_program() turns into messages.
int run(const std::vector<std::string>& words) {
  Command program{"shadowbench",
                  "Compares soft-shadow filters: pictures, cost and error of each, over the same scenes."};
  program.examples = {"shadowbench run          # a report in report/out", "shadowbench run --help"};
  program.about =
      "Exit codes: 0 done; 1 limit or baseline missed, or --strict found a warning; 2 usage; 3 input file missing, "
      "malformed or not finite; 4 no OpenGL context; 5 a filter's file; 6 output cannot be written; 70 a bug.";
  program.commands = {make_run_command(),      make_advise_command(), make_list_command(),   make_view_command(),
                      make_tune_command(),     make_bias_command(),   make_stress_command(), make_diff_command(),
                      make_regress_command(),  make_merge_command(),  make_export_command(), make_score_command(),
                      make_gpu_facts_command()};
  return run_command_line(program, words);
}

int fail_output(int error) {
  print_error(
      fmt::format("standard output cannot be written ({}); check the free space where it goes", std::strerror(error)));
  return kOutputError;
}

/// Reports where what was printed could not be written, because a disk is full or a pipe is closed.
int finish_output(int exit_code) {
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? exit_code : fail_output(errno);
}

}  // namespace

void print_error(const std::string& message) { print_message("shadowbench: {}\n", message); }

int fail_memory() {
  print_error(
      "memory ran out; raise the limit (ulimit -v), or choose a smaller --size, a smaller --map-size or fewer filters "
      "at once");
  return kInputError;
}

int run_program(const std::vector<std::string>& words) {
  try {
    return finish_output(run(words));
  } catch (const Error& error) {
    print_error(error.what());
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    return fail_memory();
  } catch (const std::filesystem::filesystem_error& error) {
    print_error(fmt::format(
        "{}: this path cannot be used ({}); check that it is there and its folders' rights, or choose another",
        error.path1().string(), error.code().message()));
    return kOutputError;
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return fail_output(error.code().value());
    print_error(fmt::format("{}; check that the folder is there, its rights and its free space", error.what()));
    return kOutputError;
  } catch (const std::exception& error) {
    print_error(fmt::format("bug: {}; please report it with the command line", error.what()));
    return kBug;
  }
}

}  // namespace shadowbench::cli
