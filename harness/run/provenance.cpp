#include "harness/run/provenance.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <fstream>
#include <thread>

#include "shadowbench_commit.h"

namespace shadowbench::run {
namespace {

std::string read_cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

}  // namespace

std::string build_commit() { return SHADOWBENCH_COMMIT; }

records::MachineRecord describe_machine() {
  records::MachineRecord machine;
  machine.cpu = read_cpu_name();
  machine.cores = static_cast<int>(std::thread::hardware_concurrency());
  double load = 0.0;
  if (getloadavg(&load, 1) == 1) machine.load_at_start = load;
  machine.compiler = fmt::format("GCC {}", __VERSION__);
  utsname system{};
  if (uname(&system) == 0) machine.os = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
  return machine;
}

records::GlRecord describe_gl(const measure::Renderer& renderer) {
  const gl::GlInfo& info = renderer.context->info();
  const bool query = renderer.timer == gl::TimerKind::kQuery;
  return {info.backend, info.renderer, info.version, info.software,
          query ? records::TimerKind::kTimerQuery : records::TimerKind::kWallClock};
}

}  // namespace shadowbench::run
