#pragma once

#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {

using nlohmann::json;

inline constexpr const char* kExperiment =
    "title = 'small'\nscene = ['cubes', 'stack']\nmap_size = [32, 64]\nsize = '64x36'\nrounds = 1\ngrids = "
    "false\nattribution = false\n"
    "[[filter]]\nid = 'none'\n[[filter]]\nid = 'vsm'\nradius = [1, 2, 3]\n[[filter]]\nid = 'poisson'\ntaps = [8, 16]\n"
    "radius = {linear = [1, 4], count = 4}\n";
inline constexpr std::size_t kCells = 2 * 2 * (1 + 3 + 2 * 4);

/// What a cell says but its times, and what a run says but what differs from run to run.
inline json without_times(json cell) {
  for (const char* name : {"time_ms", "ratio_to_none", "measured_s"}) cell.erase(name);
  cell["images"].erase("frames");  // a file of frames is named for the cells that were drawn together
  // What a page shows first depends on all of its cells' times.
  for (const char* name : {"supersampled", "truth_supersampled", "samples"}) cell["images"].erase(name);
  return cell;
}

/// Experiments of many cells, in a folder with e.toml.
class Sweep : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("e.toml", kExperiment);
  }

  json results(const std::string& out = "out") const { return json::parse(read_text(folder() / out / "results.json")); }

  /// Whether two runs hold the same cells in the same order, but for times, and warn of the same.
  void expect_same(const std::string& a, const std::string& b) const {
    const json first = results(a), second = results(b);
    ASSERT_EQ(first["cells"].size(), second["cells"].size());
    for (std::size_t i = 0; i < first["cells"].size(); ++i)
      EXPECT_EQ(without_times(first["cells"][i]), without_times(second["cells"][i])) << i;
    for (const char* name : {"experiment", "warnings", "scenes", "gl", "commit", "seed"})
      EXPECT_EQ(first[name], second[name]) << name;
  }

  /// Runs the program until its folder `out` holds so many cells, and kills it.
  void run_and_kill(const std::string& arguments, std::size_t cells) const {
    const std::string script =
        "cd '" + folder().string() + "'\nXDG_CACHE_HOME='" + cache_folder().string() + "' '" SHADOWBENCH_PROGRAM "' " +
        with_test_defaults(arguments) +
        " >/dev/null 2>&1 &\ni=0\nwhile [ $i -lt 3000 ] && [ $(ls out/cells 2>/dev/null | wc -l) -lt " +
        std::to_string(cells) + " ]; do sleep 0.02; i=$((i+1)); done\nkill -9 $!\nwait\n";
    EXPECT_EQ(std::system(("sh '" + write("kill.sh", script).string() + "'").c_str()), 0);
  }

  std::map<std::string, std::filesystem::file_time_type> cell_times(const std::string& out = "out") const {
    std::map<std::string, std::filesystem::file_time_type> times;
    for (const auto& entry : std::filesystem::directory_iterator(folder() / out / "cells"))
      times[entry.path().filename().string()] = entry.last_write_time();
    return times;
  }
};

}  // namespace shadowbench::test
