// A disk that fills up while a report is written: one message, nothing half-written, and the run goes on where there is
// room.

#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kDiskRun = "run --grids --size 96x54 --map-size 32 --rounds 1 --scene cubes --filters none,vsm ";
constexpr const char* kAdvice = "free space";

class FaultDisk : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    const Outcome outcome = run(std::string(kDiskRun) + "--out whole");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  /// Bytes of the undisturbed report, in whole blocks.
  std::uintmax_t count_bytes() const {
    std::uintmax_t bytes = 0;
    for (const auto& path : list_files("whole")) bytes += (std::filesystem::file_size(path) + 4095) / 4096 * 4096;
    return bytes;
  }

  /// What a disturbed run and the same command with room again left in folders of this name.
  void expect_survived(const std::string& name, int exit_code) const {
    EXPECT_EQ(exit_code, 6) << name;
    expect_one_message(read_text(folder() / (name + ".txt")), {kAdvice, "out/"});
    expect_whole(name);
    expect_no_leftovers(name);
    EXPECT_FALSE(std::filesystem::exists(folder() / name / "results.json")) << name;
    EXPECT_EQ(read_text(folder() / (name + ".then")), "0\n") << read_text(folder() / (name + ".then.txt"));
    expect_whole(name + "_whole");
    expect_no_leftovers(name + "_whole");
    expect_same("whole", name + "_whole");
  }
};

TEST_F(FaultDisk, FullDuringAReport_LeavesNothingHalfWritten_AndGoesOnWithRoom) {
  const auto shell = find_mounting_shell();
  if (!shell)
    GTEST_SKIP() << "no file system can be mounted here (neither as root nor with 'unshare -rm'); the limit on file "
                    "sizes stands for it";
  const double bytes = static_cast<double>(count_bytes());
  for (const int percent : {8, 30, 55, 75, 88, 96}) {
    const std::string name = "full" + std::to_string(percent);
    const auto room = static_cast<std::uintmax_t>(bytes * percent / 100.0);
    const std::string script =
        "mkdir -p disk && mount -t tmpfs -o size=" + std::to_string(room) + " none disk || exit 98\n" + "shadowbench " +
        kDiskRun + "--out disk/out 2>" + name + ".txt\ncode=$?\ncp -r disk/out " + name +
        "\nmount -o remount,size=64m disk || exit 97\nshadowbench " + kDiskRun + "--out disk/out 2>" + name +
        ".then.txt\necho $? >" + name + ".then\ncp -r disk/out " + name + "_whole\nexit $code\n";
    expect_survived(name, run_script(*shell, script));
  }
}

/// A limit on file sizes, which needs no rights, stops the larger files at their beginning, middle and end.
TEST_F(FaultDisk, FilesThatMayNotGrow_LeaveNothingHalfWritten_AndTheRunGoesOn) {
  for (const int blocks : {2, 16, 100}) {  // of 512 bytes
    const std::string name = "limit" + std::to_string(blocks);
    const std::string script = std::string("mkdir ") + name + "\n(ulimit -f " + std::to_string(blocks) +
                               "; shadowbench " + kDiskRun + "--no-cache --out " + name + "/out) 2>" + name +
                               ".txt\ncode=$?\ncp -r " + name + "/out kept\nshadowbench " + kDiskRun + "--out " + name +
                               "/out 2>" + name + ".then.txt\necho $? >" + name + ".then\nmv " + name + "/out " + name +
                               "_whole\nrm -r " + name + "\nmv kept " + name + "\nexit $code\n";
    expect_survived(name, run_script("", script));
  }
}

TEST_F(FaultDisk, FullCache_IsSaid_AndCostsNothingElse) {
  const auto shell = find_mounting_shell();
  if (!shell) GTEST_SKIP() << "no file system can be mounted here (neither as root nor with 'unshare -rm')";
  const std::string script =
      std::string("mkdir disk && mount -t tmpfs -o size=8k none disk || exit 98\nshadowbench ") + kDiskRun +
      "--cache disk/cache --out out 2>messages.txt\ncode=$?\ncp -r disk/cache kept\nexit $code\n";
  EXPECT_EQ(run_script(*shell, script), 0) << read_text(folder() / "messages.txt");
  EXPECT_THAT(read_text(folder() / "messages.txt"), HasSubstr("traced images are not kept for the next run"));
  expect_whole("kept");
  expect_no_leftovers("kept");
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(results()["cells"][i]["error"], results("whole")["cells"][i]["error"]) << i;
}

/// Mesa maps the index of its own cache into memory: a disk that cannot hold it ended the program with SIGBUS.
TEST_F(FaultDisk, FullDiskUnderTheDriversCache_SwitchesThatOff) {
  const auto shell = find_mounting_shell();
  if (!shell) GTEST_SKIP() << "no file system can be mounted here (neither as root nor with 'unshare -rm')";
  const std::string script = std::string(
                                 "mkdir disk && mount -t tmpfs -o size=16k none disk || exit 98\nunset "
                                 "MESA_SHADER_CACHE_DISABLE MESA_SHADER_CACHE_DIR\n") +
                             "export XDG_CACHE_HOME=$PWD/disk\nshadowbench " + kDiskRun +
                             "--no-cache --out out 2>messages.txt\n";
  EXPECT_EQ(run_script(*shell, script), 0) << read_text(folder() / "messages.txt");
  EXPECT_THAT(read_text(folder() / "messages.txt"), HasSubstr("not used: the driver's cache of shaders in "));
  expect_same("whole", "out");
}

/// What goes to a full disk by way of the shell is lost too, and must not pass for done.
TEST_F(FaultDisk, FullStandardOutput_IsAnOutputError) {
  EXPECT_EQ(run_script("", "shadowbench list filters >/dev/full"), 6);
  expect_one_message(read_text(folder() / "script.txt"), {"standard output", "No space left"});
}

}  // namespace
}  // namespace shadowbench::test
