#include "harness/gl/context/context.h"
#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

// Output folders that cannot be written, vanish, or are another run's at the moment; runs that are stopped at random
// moments: what was finished is intact, and the same command goes on from there.

constexpr const char* kSmallFolderRun =
    "--size 32x18 --map-size 16 --rounds 1 --scene cubes --no-attribution --filters none,pcf2x2 ";

class FaultFolder : public FaultTest {
 protected:
  void run_whole() const { succeed("run " + std::string(kSmallFolderRun) + "--no-grids --out whole"); }

  bool is_taken() const { return exists("out/.shadowbench-lock"); }
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
  ASSERT_TRUE(wait_until([&] { return is_taken(); })) << read("started.txt");
  for (const std::string& command : list_commands()) {
    const Outcome outcome = run(command + " --out out");
    EXPECT_EQ(outcome.exit_code, 6) << command << "\n" << outcome.err;
    expect_one_message(outcome.err,
                       {"out: ", "process " + std::to_string(first) + " writes into this folder", "--out"});
  }
  EXPECT_EQ(count_cells(), 0u) << "another wrote into it";
  kill(first, SIGKILL);
  EXPECT_EQ(wait_for(first).signal, SIGKILL);
  expect_no_process();
  succeed("run " + std::string(kSmallFolderRun) + "--no-grids --out out");
  expect_no_leftovers("out");
  expect_same("whole", "out");
}

TEST_F(FaultFolder, OfAMergeThatWasStopped_IsGoneOnWith_AndThatOfAnotherIsNot) {
  run_whole();
  EXPECT_EQ(run_script("", "ulimit -f 20\nshadowbench merge whole --out out"), 6) << "the schema is larger";
  expect_one_message(read("script.txt"), {"out/", "free space", "--out"});
  expect_whole("out");
  EXPECT_FALSE(exists("out/results.json"));
  EXPECT_GT(count_cells(), 0u);
  succeed("merge whole --out out");
  expect_no_leftovers("out");
  expect_same("whole", "out");
  std::filesystem::create_directories(folder() / "other" / "cells");
  write("other/cells/0123456789abcdef.json", "{}");
  write("other/.shadowbench-folder", "");
  expect_refusal("merge whole --out other", 2, {"other", "there is a report in this folder already"});
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
    ASSERT_TRUE(wait_until([&] { return count_cells() > 0; })) << read("started.txt");
    std::filesystem::rename(folder() / "out", folder() / "moved");
    if (way == std::string("a file now")) write("out", "a file");
    const Ending ending = wait_for(pid);
    EXPECT_EQ(ending.exit_code, 6) << way << " " << ending.signal;
    const std::string text = read("started.txt");
    expect_one_message(text, {"out", "--out"});
    EXPECT_THAT(last_line(text), HasSubstr("out: this folder was removed or replaced")) << way;
    expect_whole("moved");
    std::filesystem::remove_all(folder() / "out");
    if (way == std::string("renamed")) std::filesystem::rename(folder() / "moved", folder() / "out");
    std::filesystem::remove_all(folder() / "moved");
    succeed("run e.toml --out out");
    expect_no_leftovers("out");
    EXPECT_EQ(read_cells().size(), 54u);
    std::filesystem::remove_all(folder() / "out");
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
  expect_one_message(read("script.txt"), {"out: ", "Permission denied", "rights", "--out"});
}

/// Pictures are written beside other work.
TEST_F(FaultFolder, WhereAPictureOrAFolderCannotBe_IsAnOutputErrorThatNamesIt) {
  write("file", "a file");
  for (const char* out : {"file", "file/inner"}) {
    const Outcome outcome = run("run " + std::string(kSmallFolderRun) + "--out " + out);
    EXPECT_EQ(outcome.exit_code, 6);
    expect_one_message(outcome.err, {out, "--out"});
  }
  for (const char* picture : {"images/cubes.none.picture.png", "cubes.grid.png"}) {
    std::filesystem::create_directories(folder() / "out" / picture);
    const Outcome outcome = run("run --grids --force --out out " + std::string(kSmallFolderRun));
    EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
    expect_one_message(outcome.err, {picture, "--out"});
    std::filesystem::remove_all(folder() / "out");
  }
}

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
    expect_no_process();
  }

  /// What it must have said, and how it ended.
  void expect_goodbye(const Ending& ending, int signal) const {
    EXPECT_EQ(ending.signal, signal) << read("started.txt");
    const std::string text = read("started.txt");
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
  succeed(command("whole"));
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
  succeed(command("out"));
  expect_equal_and_clear();
  RecordProperty("finished", finished);
}

/// The worker of a user's filter has a process group of its own, and must not outlive the run.
TEST_F(FaultSignal, WhileAUsersFilterIsMeasured_NoChildStays) {
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const pid_t pid = start_endless();
    const std::filesystem::path worker =
        folder() / "out" / (".worker-" + std::to_string(pid) + "-" + this_writer().host);
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(worker); })) << read("started.txt");
    std::this_thread::sleep_for(
        std::chrono::milliseconds(1500));  // by now it says nothing more, and a closed pipe would not end it
    kill(pid, signal);
    expect_goodbye(wait_for(pid), signal);
    expect_no_process();
  }
  succeed("run --size 32x18 --map-size 16 --rounds 1 --scene cubes --filters none --out out");
  expect_no_leftovers("out");
}

TEST_F(FaultSignal, OtherCommands_SayThatTheyWereStopped) {
  const char* commands[] = {"bias --size 320x180 --out out", "stress --out out", "tune --filters vsm --out out"};
  for (const char* each : commands) {
    const pid_t pid = start(each);
    ASSERT_TRUE(wait_until([&] { return !read("started.txt").empty() || exists("out"); })) << each;
    kill(pid, SIGINT);
    EXPECT_EQ(wait_for(pid).signal, SIGINT) << each;
    expect_one_message(read("started.txt"), {"stopped by SIGINT", "run the same command again"});
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
  EXPECT_EQ(status, 0) << read("script.txt");
}

// Disks that fill up, a cache that cannot be used, memory that runs out, and OpenGL that is refused: one message each,
// nothing half-written, and results that are the same.

constexpr const char* kDiskRun = "run --grids --size 96x54 --map-size 32 --rounds 1 --scene cubes --filters none,vsm ";
constexpr const char* kAdvice = "free space";

class FaultDisk : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    succeed(std::string(kDiskRun) + "--out whole");
  }

  /// What a disturbed run and the same command with room again left in folders of this name.
  void expect_survived(const std::string& name, int exit_code) const {
    EXPECT_EQ(exit_code, 6) << name;
    expect_one_message(read(name + ".txt"), {kAdvice, "out/"});
    expect_whole(name);
    expect_no_leftovers(name);
    EXPECT_FALSE(std::filesystem::exists(folder() / name / "results.json")) << name;
    EXPECT_EQ(read(name + ".then"), "0\n") << read(name + ".then.txt");
    expect_whole(name + "_whole");
    expect_no_leftovers(name + "_whole");
    expect_same("whole", name + "_whole");
  }
};

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

TEST_F(FaultDisk, CacheOnAReadOnlyMount_IsRead_AndNotWritten) {
  const auto shell = find_mounting_shell();
  if (!shell) GTEST_SKIP() << "no file system can be mounted here (neither as root nor with 'unshare -rm')";
  const std::string script =
      "mount --bind cache cache && mount -o remount,bind,ro cache || exit 98\nrm -f cache/no 2>/dev/null\nshadowbench ";
  EXPECT_EQ(run_script(*shell, script + kDiskRun + "--out out"), 0);
  EXPECT_EQ(read_results()["work"]["truths_traced"], 0);
  EXPECT_THAT(read("script.txt"), Not(HasSubstr("warning")));
  EXPECT_EQ(run_script(*shell, script + kDiskRun + "--seed 2 --out out"), 0);
  EXPECT_THAT(read("script.txt"), HasSubstr("warning: traced images are not kept for the next run"));
  EXPECT_THAT(read("script.txt"), HasSubstr("Read-only file system"));
}

TEST_F(FaultDisk, FullCache_IsSaid_AndCostsNothingElse) {
  const auto shell = find_mounting_shell();
  if (!shell) GTEST_SKIP() << "no file system can be mounted here (neither as root nor with 'unshare -rm')";
  const std::string script =
      std::string("mkdir disk && mount -t tmpfs -o size=8k none disk || exit 98\nshadowbench ") + kDiskRun +
      "--cache disk/cache --out out 2>messages.txt\ncode=$?\ncp -r disk/cache kept\nexit $code\n";
  EXPECT_EQ(run_script(*shell, script), 0) << read("messages.txt");
  EXPECT_THAT(read("messages.txt"), HasSubstr("traced images are not kept for the next run"));
  expect_whole("kept");
  expect_no_leftovers("kept");
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(read_cells()[i]["error"], read_results("whole")["cells"][i]["error"]) << i;
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
  EXPECT_EQ(run_script(*shell, script), 0) << read("messages.txt");
  EXPECT_THAT(read("messages.txt"), HasSubstr("not used: the driver's cache of shaders in "));
  expect_same("whole", "out");
}

/// What goes to a full disk by way of the shell is lost too, and must not pass for done.
TEST_F(FaultDisk, FullStandardOutput_IsAnOutputError) {
  EXPECT_EQ(run_script("", "shadowbench list filters >/dev/full"), 6);
  expect_one_message(read("script.txt"), {"standard output", "No space left"});
}

class FaultLimits : public FaultTest {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "address sanitizer's shadow memory alone is beyond any limit";
#endif
    FaultTest::SetUp();
  }

  /// Writes a model of one mesh with so many vertices, whose buffer is a hole in the file system.
  void write_large_model(std::uintmax_t vertices) const {
    const std::uintmax_t bytes = vertices * 12;
    write("large.gltf",
          "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
          "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"buffers\":[{\"uri\":\"large.bin\","
          "\"byteLength\":" +
              std::to_string(bytes) + "}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":" + std::to_string(bytes) +
              "}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":" +
              std::to_string(vertices) + ",\"min\":[0,0,0],\"max\":[0,0,0]}]}");
    write("large.bin", "");
    std::filesystem::resize_file(folder() / "large.bin", bytes);
  }

  int run_limited(std::size_t mebibytes, const std::string& arguments) const {
    return run_script("", "export LP_NUM_THREADS=1 MALLOC_ARENA_MAX=2\nulimit -v " + std::to_string(1024 * mebibytes) +
                              "\nshadowbench " + arguments);
  }
};

TEST_F(FaultLimits, MemoryThatALargeModelDoesNotFitInto_IsAnInputErrorThatNamesTheModel) {
  constexpr std::uintmax_t kVertices = 60'000'000;
  write_large_model(kVertices);
  constexpr const char* kRest =
      " --gl software --size 32x18 --map-size 16 --rounds 1 --filters none --no-attribution --out out";
  for (const std::size_t mebibytes : {1600, 2200, 3400}) {
    const int code = run_limited(mebibytes, std::string("run --scene large.gltf") + kRest);
    EXPECT_EQ(code, 3) << mebibytes << " " << read("script.txt");
    expect_one_message(read("script.txt"), {"large.gltf", "memory ran out", "ulimit -v"});
    EXPECT_FALSE(exists("out"));
  }
  EXPECT_EQ(run_limited(1600, std::string("run --scene cubes") + kRest), 0)
      << "the limit alone is enough to stop a run: " << read("script.txt");
}

TEST_F(FaultLimits, MemoryThatOtherThingsDoNotFitInto_IsSaidToo) {
  write("large.pgm", "P5\n30000 30000\n255\n");
  std::filesystem::resize_file(folder() / "large.pgm", 900'000'020);
  EXPECT_EQ(run_limited(1200, "diff large.pgm large.pgm"), 3);
  expect_one_message(read("script.txt"), {"memory ran out", "ulimit -v"});
}

/// The loader itself fails below 600 MB on Debian 12, and below 700 MB on Debian 13, before anything of the program
/// runs.
TEST_F(FaultLimits, MemoryThatIsTooSmallToStartIn_IsOneMessage) {
  for (const std::size_t mebibytes : {600, 700, 800, 920, 1000}) {
    const int code =
        run_limited(mebibytes, "run --scene cubes --gl software --size 2048x2048 --filters none,vsm --out out");
    if (mebibytes < 700 && code == 127) continue;
    EXPECT_EQ(code, 3) << mebibytes;
    const std::string said = read("script.txt");
    EXPECT_THAT(said, HasSubstr("shadowbench: ")) << mebibytes;
    EXPECT_THAT(said, AnyOf(HasSubstr("ulimit -v"), HasSubstr("not enough memory"))) << said;
    EXPECT_THAT(said, Not(HasSubstr("terminate called"))) << mebibytes;
  }
}

using FaultContext = FaultTest;

TEST_F(FaultContext, Refused_IsOneMessage) {
  struct Context {
    const char* environment;
    const char* backend;
    const char* word;
  };
  const bool has_osmesa = gl::has_backend(gl::Backend::kOsmesa);
  const std::array refusals = {
      Context{"__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null", "egl", "egl: no device"},
      Context{"-u DISPLAY -u WAYLAND_DISPLAY", "glfw", "glfw: GLFW does not start"},
      Context{"-u WAYLAND_DISPLAY DISPLAY=:9999", "glfw", "glfw: GLFW does not start"},
      Context{"MESA_GL_VERSION_OVERRIDE=2.1", "software",
              has_osmesa ? "osmesa: OSMesa gives no OpenGL 4.5 core context" : "egl in software: "},
      Context{"MESA_GL_VERSION_OVERRIDE=2.1 __EGL_VENDOR_LIBRARY_FILENAMES=/dev/null DISPLAY=:9999", "auto",
              has_osmesa ? "osmesa: OSMesa gives" : "egl: no device"}};
  for (const Context& each : refusals) {
    std::vector<std::string> commands = {"run --scene cubes"};
    if (each.backend == std::string("glfw")) commands.insert(commands.end(), {"bias", "stress", "tune --filters vsm"});
    for (const std::string& command : commands) {
      const std::string line = std::string("env ") + each.environment + " '" SHADOWBENCH_PROGRAM "' " + command +
                               " --out out --gl " + each.backend;
      EXPECT_EQ(run_script("", line), 4) << line;
      expect_one_message(read("script.txt"), {"no OpenGL 4.5 core context", each.word, "--gl"});
      EXPECT_FALSE(exists("out")) << line;
    }
  }
}

}  // namespace
}  // namespace shadowbench::test
