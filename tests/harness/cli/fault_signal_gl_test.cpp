// Runs that are stopped at random moments: what was finished is intact, and the same command goes on from there.

#include <random>

#include "base/files.h"
#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kStops = 9;  // three of each signal
constexpr const char* kLastLine = "what was finished stays, and the same command goes on from there";

class FaultSignal : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    write("e.toml",
          "scene = 'cubes'\nmap_size = 32\nsize = '48x27'\nrounds = 1\ngrids = false\nattribution = false\n"
          "[[filter]]\nid = 'none'\n[[filter]]\nid = 'vsm'\nradius = {linear = [1, 10], count = 10}\n");
  }

  std::string command(const std::string& out) const {
    return "run e.toml --filter-file " + user_filter("stored_plane.glsl") +
           " --filters none,vsm,esm,pcf2x2,tent3x3,box4x4,box3x3,poisson,stored_plane --out " + out;
  }

  /// What a stopped run may leave.
  void expect_intact() const {
    for (const auto& path : list_files("out")) {
      if (path.parent_path().filename() != "cells" || path.string().find("tmp-") != std::string::npos ||
          path.string().find(".worker-") != std::string::npos)
        continue;
      const records::CellRecord cell = records::read_cell(folder() / "out", path.stem().string());
      for (const auto& image : {cell.images.picture, cell.images.visibility})
        if (!image)
          ADD_FAILURE() << path << " names no picture";
        else
          EXPECT_FALSE(images::read_picture(folder() / "out" / *image).texels.empty()) << *image;
    }
    expect_whole("out");
    EXPECT_THAT(list_processes(), IsEmpty());
  }

  /// What it must have said, and how it ended.
  void expect_goodbye(const Ending& ending, int signal) const {
    EXPECT_EQ(ending.signal, signal) << read_text(folder() / "started.txt");
    const std::string text = read_text(folder() / "started.txt");
    if (signal == SIGKILL || text.empty()) return;
    if (last_line(text).ends_with(" done")) return expect_same("whole", "out");  // nothing was left to stop
    expect_one_message(text, {signal == SIGINT ? "stopped by SIGINT" : "stopped by SIGTERM", kLastLine});
  }

  /// Expects that the run that has just finished equals the undisturbed one, and makes place for the next.
  void expect_equal_and_clear() const {
    expect_same("whole", "out");
    expect_no_leftovers("out");
    expect_no_leftovers("cache");
    std::filesystem::remove_all(folder() / "out");
    std::filesystem::remove_all(cache_folder());
  }
};

TEST_F(FaultSignal, ManyTimesAtRandomMoments_NothingIsLost) {
  const auto begin = std::chrono::steady_clock::now();
  const Outcome whole = run(command("whole"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::filesystem::remove_all(cache_folder());
  std::mt19937 random(9);
  std::uniform_real_distribution<double> moment(0.0, 1.0);
  int stops = 0, finished = 0;
  std::size_t kept = 0;
  while (stops < kStops) {
    const int signal = stops % 3 == 0 ? SIGINT : stops % 3 == 1 ? SIGTERM : SIGKILL;
    const pid_t pid = start(command("out"));
    std::this_thread::sleep_for(std::chrono::duration<double>(moment(random) * seconds));
    kill(pid, signal);
    const Ending ending = wait_for(pid);
    if (ending.exit_code == 0) {
      ++finished;
      seconds *= 0.8;  // the first run had shaders to compile, and perhaps a busier machine
      expect_equal_and_clear();
      kept = 0;
      continue;
    }
    ++stops;
    expect_goodbye(ending, signal);
    expect_intact();
    EXPECT_GE(count_cells(), kept) << "what was finished is gone";
    kept = count_cells();
    if (HasFailure()) FAIL() << "stop " << stops << " by signal " << signal;
  }
  const Outcome last = run(command("out"));
  ASSERT_EQ(last.exit_code, 0) << last.err;
  expect_equal_and_clear();
  RecordProperty("finished", finished);
}

/// The worker of a user's filter has a process group of its own, and must not outlive the run.
TEST_F(FaultSignal, WhileAUsersFilterIsMeasured_NoChildStays) {
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const pid_t pid = start(
        "run --size 320x180 --map-size 64 --rounds 1 --scene cubes --filters none,endless --cell-timeout 600 --out out "
        "--filter-file " +
        user_filter("endless.glsl"));
    const std::filesystem::path worker =
        folder() / "out" / (".worker-" + std::to_string(pid) + "-" + this_writer().host);
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(worker); })) << read_text(folder() / "started.txt");
    std::this_thread::sleep_for(
        std::chrono::milliseconds(1500));  // by now it says nothing more, and a closed pipe would not end it
    kill(pid, signal);
    expect_goodbye(wait_for(pid), signal);
    EXPECT_THAT(list_processes(), IsEmpty());
  }
  ASSERT_EQ(run("run --size 32x18 --map-size 16 --rounds 1 --scene cubes --filters none --out out").exit_code, 0);
  expect_no_leftovers("out");
}

TEST_F(FaultSignal, OtherCommands_SayThatTheyWereStopped) {
  const char* commands[] = {"bias --size 320x180 --out out", "stress --out out", "tune --filters vsm --out out"};
  for (const char* each : commands) {
    const pid_t pid = start(each);
    ASSERT_TRUE(wait_until([&] {
      return !read_text(folder() / "started.txt").empty() || std::filesystem::exists(folder() / "out");
    })) << each;
    kill(pid, SIGINT);
    EXPECT_EQ(wait_for(pid).signal, SIGINT) << each;
    expect_one_message(read_text(folder() / "started.txt"), {"stopped by SIGINT", "run the same command again"});
    expect_whole("out");
    std::filesystem::remove_all(folder() / "out");
    std::filesystem::remove(folder() / "started.txt");
  }
}

/// A program that was started to ignore a signal, as by nohup, goes on.
TEST_F(FaultSignal, IgnoredSignals_StayIgnored) {
  const int status =
      run_script("", "trap '' HUP\n'" SHADOWBENCH_PROGRAM
                     "' run --size 64x36 --map-size 16 --rounds 1 --scene cubes --filters none --out out &\n"
                     "i=0\nwhile [ ! -e out/.shadowbench-lock ] && [ $i -lt 1000 ]; do sleep 0.01; i=$((i+1)); "
                     "done\nkill -HUP $! && wait $!");
  EXPECT_EQ(status, 0) << read_text(folder() / "script.txt");
}

}  // namespace
}  // namespace shadowbench::test
