#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "harness/cli/commands.h"

namespace shadowbench::cli {
namespace {

/// Libraries that find no memory while they start crash, or throw where nobody can catch: this comes before them, and
/// uses none.
void require_address_space() {
  constexpr rlim_t kLeast = rlim_t{900} << 20;
  constexpr std::string_view kMessage =
      "shadowbench: the address space of this process is limited (ulimit -v), and 900 MB is the least that it starts "
      "with; raise the limit\n";
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kLeast) return;
  if (write(STDERR_FILENO, kMessage.data(), kMessage.size()) < 0) std::_Exit(static_cast<int>(ErrorKind::kOutput));
  std::_Exit(static_cast<int>(ErrorKind::kInput));
}

[[gnu::section(".preinit_array"), gnu::used]] void (*const kBeforeLibraries)() = require_address_space;

/// What a thread of a library throws, and nobody catches: no memory, or no further thread.
[[noreturn]] void end_uncaught() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    std::_Exit(fail_memory());
  } catch (const std::system_error& error) {
    print_error(fmt::format("{}; raise the limits on memory and threads (ulimit -v, ulimit -u)", error.what()));
    std::_Exit(static_cast<int>(ErrorKind::kInput));
  } catch (const std::exception& error) {
    print_error(fmt::format("bug: {}", error.what()));
  }
  std::abort();
}

}  // namespace
}  // namespace shadowbench::cli

int main(int argc, char** argv) {
  using namespace shadowbench::cli;
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes becomes an error of the write, as a full disk is
  std::set_terminate(end_uncaught);
  return run_program({argv, argv + argc});
}
