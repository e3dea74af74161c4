// Output folders that cannot be written, vanish, or are another run's at the moment.

#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSmallFolderRun =
    "--size 32x18 --map-size 16 --rounds 1 --scene cubes --no-attribution --filters none,pcf2x2 ";

class FaultFolder : public FaultTest {
 protected:
  void run_whole() const {
    ASSERT_EQ(run("run " + std::string(kSmallFolderRun) + "--no-grids --out whole").exit_code, 0);
  }

  /// Starts a run that stays in the folder `out` until it is killed.
  pid_t start_endless() const {
    return start(
        "run --size 320x180 --map-size 64 --rounds 1 --scene cubes --filters none,endless --cell-timeout 600 --out out "
        "--filter-file " +
            user_filter("endless.glsl"),
        "first.txt");
  }

  bool is_taken() const { return std::filesystem::exists(folder() / "out" / ".shadowbench-lock"); }
};

/// Each command that writes a folder.
std::vector<std::string> list_commands() {
  return {std::string("run --grids ") + kSmallFolderRun,
          std::string("run --no-grids --fresh ") + kSmallFolderRun,
          "merge whole",
          "bias --scene cubes --filters none --map-size 64 --size 160x90",
          "stress --axes taps --filters poisson:taps=8",
          "tune --filters vsm --scene cubes --map-size 64 --size 64x36 --budget 3"};
}

TEST_F(FaultFolder, OfARunThatGoesOn_IsRefusedToAllOthers_AndFreeOnceItIsKilled) {
  run_whole();
  const pid_t first = start_endless();
  ASSERT_TRUE(wait_until([&] { return is_taken(); })) << read_text(folder() / "first.txt");
  for (const std::string& command : list_commands()) {
    const Outcome outcome = run(command + " --out out");
    EXPECT_EQ(outcome.exit_code, 6) << command << "\n" << outcome.err;
    expect_one_message(outcome.err,
                       {"out: ", "process " + std::to_string(first) + " writes into this folder", "--out"});
  }
  EXPECT_EQ(count_cells(), 0u) << "another wrote into it";
  kill(first, SIGKILL);
  EXPECT_EQ(wait_for(first).signal, SIGKILL);
  EXPECT_THAT(list_processes(), ::testing::IsEmpty()) << "the worker of the user's filter";
  const Outcome outcome = run("run " + std::string(kSmallFolderRun) + "--no-grids --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_no_leftovers("out");
  expect_same("whole", "out");
}

/// What somebody else put there stays, be it named as files of ours are.
TEST_F(FaultFolder, OfSomebodyElse_IsRefusedToAll_UnlessItIsForced) {
  run_whole();
  std::vector<std::string> commands = list_commands();
  commands.insert(commands.end(), {"export cubes", "regress whole --baseline none"});
  for (const char* name : {"index.html", "results.json", ".worker-99999999/a", "b.shadowbench-tmp-99999999.png"})
    write(std::string("out/") + name, "mine");
  for (const std::string& command : commands) {
    const Outcome outcome = run(command + " --out out");
    EXPECT_EQ(outcome.exit_code, 6) << command << "\n" << outcome.err;
    expect_one_message(outcome.err, {"out: ", "--force"});
    EXPECT_EQ(list_files("out").size(), 4u) << command;
  }
  const Outcome forced = run("export cubes --force --out out");
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_EQ(read_text(folder() / "out" / "results.json"), "mine");
}

/// A report that is meant to be sent would hold what the link leads to.
TEST_F(FaultFolder, WithLinks_IsNeitherMergedNorWritten) {
  run_whole();
  const std::filesystem::path images = folder() / "whole" / "images";
  std::filesystem::rename(images, folder() / "elsewhere");
  std::filesystem::create_directory_symlink("../elsewhere", images);
  expect_refusal("merge whole --out out", 3, {"whole/images", "a link"});
  EXPECT_THAT(list_files("out"), ::testing::IsEmpty());
  const Outcome outcome = run("run --fresh --no-grids --out whole " + std::string(kSmallFolderRun));
  EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
  expect_one_message(outcome.err, {"whole/images", "a link"});
}

TEST_F(FaultFolder, OfAMergeThatWasStopped_IsGoneOnWith_AndThatOfAnotherIsNot) {
  run_whole();
  EXPECT_EQ(run_script("", "ulimit -f 20\nshadowbench merge whole --out out"), 6) << "the schema is larger";
  expect_one_message(read_text(folder() / "script.txt"), {"out/", "free space", "--out"});
  expect_whole("out");
  EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "results.json"));
  EXPECT_GT(count_cells(), 0u);
  const Outcome again = run("merge whole --out out");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  expect_no_leftovers("out");
  expect_same("whole", "out");
  std::filesystem::create_directories(folder() / "other" / "cells");
  write("other/cells/0123456789abcdef.json", "{}");
  const Outcome refused = run("merge whole --out other");
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  expect_one_message(refused.err, {"other", "there is a report in this folder already"});
}

TEST_F(FaultFolder, TakenByManyAtOnce_BelongsToOne) {
  run_whole();
  std::vector<pid_t> all;
  for (int i = 0; i < 5; ++i)
    all.push_back(
        start("run " + std::string(kSmallFolderRun) + "--no-grids --out out", "many" + std::to_string(i) + ".txt"));
  int done = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Ending ending = wait_for(all[i]);
    if (ending.exit_code == 0) {
      ++done;
      continue;
    }
    EXPECT_EQ(ending.exit_code, 6) << ending.signal;
    expect_one_message(read_text(folder() / ("many" + std::to_string(i) + ".txt")), {"writes into this folder"});
  }
  EXPECT_GE(done, 1);
  expect_no_leftovers("out");
  expect_same("whole", "out");
}

TEST_F(FaultFolder, SharedCache_ServesManyAtOnce) {
  const std::string arguments =
      "run --size 64x36 --map-size 32 --rounds 1 --scene cubes --scene stack --filters none,pcf2x2,vsm --no-grids ";
  std::vector<pid_t> all;
  for (int i = 0; i < 4; ++i)
    all.push_back(start(arguments + "--out out" + std::to_string(i), "many" + std::to_string(i) + ".txt"));
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(wait_for(all[i]).exit_code, 0) << read_text(folder() / ("many" + std::to_string(i) + ".txt"));
  for (const char* other : {"out1", "out2", "out3"}) expect_same("out0", other);
  expect_whole("cache");
  expect_no_leftovers("cache");
}

TEST_F(FaultFolder, ThatVanishesDuringARun_IsAnOutputError_AndTheCommandWorksAgain) {
  write("e.toml",
        "scene = ['cubes', 'stack']\nmap_size = [32, 64, 96]\nsize = '64x36'\nrounds = 1\ngrids = false\nattribution = "
        "false\n"
        "[[filter]]\nid = 'none'\n[[filter]]\nid = 'vsm'\nradius = {linear = [1, 8], count = 8}\n");
  for (const char* way : {"removed", "renamed", "a file now"}) {
    const pid_t pid = start("run e.toml --out out");
    ASSERT_TRUE(wait_until([&] { return count_cells() > 0; })) << read_text(folder() / "started.txt");
    std::filesystem::rename(folder() / "out", folder() / "moved");
    if (way == std::string("a file now")) write("out", "a file");
    const Ending ending = wait_for(pid);
    EXPECT_EQ(ending.exit_code, 6) << way << " " << ending.signal;
    const std::string text = read_text(folder() / "started.txt");
    expect_one_message(text, {"out", "--out"});
    EXPECT_THAT(last_line(text), HasSubstr("out: this folder was removed or replaced")) << way;
    expect_whole("moved");
    std::filesystem::remove_all(folder() / "out");
    if (way == std::string("renamed")) std::filesystem::rename(folder() / "moved", folder() / "out");
    std::filesystem::remove_all(folder() / "moved");
    const Outcome again = run("run e.toml --out out");
    EXPECT_EQ(again.exit_code, 0) << again.err;
    expect_no_leftovers("out");
    EXPECT_EQ(results()["cells"].size(), 54u);
    std::filesystem::remove_all(folder() / "out");
  }
}

TEST_F(FaultFolder, OnAReadOnlyMount_IsAnOutputErrorForEveryCommand) {
  const auto shell = find_mounting_shell();
  if (!shell)
    GTEST_SKIP() << "no file system can be mounted here (neither as root nor with 'unshare -rm'); root may write where "
                    "rights forbid it";
  run_whole();
  for (const std::string& command : list_commands()) {
    const std::string script =
        "mkdir -p disk && mount -t tmpfs none disk && mkdir disk/out && mount -o remount,ro disk || exit "
        "98\nshadowbench " +
        command + " --out disk/out";
    EXPECT_EQ(run_script(*shell, script), 6) << command;
    expect_one_message(read_text(folder() / "script.txt"), {"disk/out: ", "Read-only file system", "--out"});
  }
}

TEST_F(FaultFolder, WithoutTheRightToWrite_IsAnOutputError) {
  std::filesystem::create_directories(folder() / "out");
  std::filesystem::create_directories(cache_folder());
  std::filesystem::permissions(cache_folder(), std::filesystem::perms::all);
  std::filesystem::permissions(folder() / "out",
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec |
                                   std::filesystem::perms::others_read | std::filesystem::perms::others_exec);
  const bool is_root = geteuid() == 0;
  const std::string as_nobody = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
  if (is_root && std::system((as_nobody + "test -x '" SHADOWBENCH_PROGRAM "' 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "root may write everywhere, and 'setpriv' cannot run the program as nobody here";
  EXPECT_EQ(run_script("", (is_root ? as_nobody + "'" SHADOWBENCH_PROGRAM "' run " : "shadowbench run ") +
                               kSmallFolderRun + "--out out"),
            6);
  expect_one_message(read_text(folder() / "script.txt"), {"out: ", "Permission denied", "rights", "--out"});
}

/// Pictures are written beside other work.
TEST_F(FaultFolder, WhereAPictureCannotBe_IsAnOutputErrorThatNamesIt) {
  for (const char* picture : {"images/cubes.none.picture.png", "cubes.grid.png"}) {
    std::filesystem::create_directories(folder() / "out" / picture);
    const Outcome outcome = run("run --grids --force --out out " + std::string(kSmallFolderRun));
    EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
    expect_one_message(outcome.err, {picture, "--out"});
    std::filesystem::remove_all(folder() / "out");
  }
}

TEST_F(FaultFolder, ThatIsAFile_IsAnOutputErrorForEveryCommand) {
  run_whole();
  write("out", "a file");
  for (const std::string& command : list_commands()) {
    const Outcome outcome = run(command + " --out out");
    EXPECT_EQ(outcome.exit_code, 6) << command << " " << outcome.err;
    expect_one_message(outcome.err, {"out: ", "--out"});
  }
  const Outcome inner = run("run " + std::string(kSmallFolderRun) + "--out out/inner");
  EXPECT_EQ(inner.exit_code, 6) << inner.err;
  expect_one_message(inner.err, {"out/inner: ", "--out"});
  EXPECT_EQ(read_text(folder() / "out"), "a file");
}

}  // namespace
}  // namespace shadowbench::test
