#include "harness/submit/engine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.h"

namespace shadowbench::submit {
namespace {

struct EngineEntry {
  const char* name;
  std::unique_ptr<Engine> (*make)(const EngineOptions& options, const std::filesystem::path& out);
};

constexpr std::array<EngineEntry, 2> kEngines = {{{"slurm", make_slurm_engine}, {"parallel", make_parallel_engine}}};

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-_./=,:+@%", c) != nullptr;
}

std::string quote(const std::string& word) {
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::vector<std::string> list_engines() {
  std::vector<std::string> names;
  for (const EngineEntry& each : kEngines) names.emplace_back(each.name);
  return names;
}

std::unique_ptr<Engine> make_engine(const EngineOptions& options, const std::filesystem::path& out) {
  const auto found = std::ranges::find(kEngines, options.engine, &EngineEntry::name);
  if (found == kEngines.end())
    throw Error(ErrorKind::kUsage,
                fmt::format("--engine: '{}' must be one of {}", options.engine, fmt::join(list_engines(), ", ")));
  return found->make(options, out);
}

std::string quote_words(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quote(word);
  return line;
}

ShellOutcome run_shell(const std::string& command) {
  std::FILE* pipe = popen(("{ " + command + "\n} 2>&1").c_str(), "re");
  if (!pipe) throw Error(ErrorKind::kOutput, std::string("cannot start a shell: ") + std::strerror(errno));
  ShellOutcome outcome;
  std::array<char, 4096> buffer;
  for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.text.append(buffer.data(), got);
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  while (outcome.text.ends_with('\n')) outcome.text.pop_back();
  return outcome;
}

}  // namespace shadowbench::submit
