// Disks that fill up, a cache that cannot be used, memory that runs out, and OpenGL that is refused: one message each,
// nothing half-written, and results that are the same.

#include <sys/stat.h>

#include "harness/gl/context/context.h"
#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

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

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kIsSanitized = true;  // its shadow memory alone is beyond any limit
#else
constexpr bool kIsSanitized = false;
#endif

class FaultLimits : public FaultTest {
 protected:
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
  if (kIsSanitized) GTEST_SKIP() << "address sanitizer needs more memory than a limit leaves";
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
  if (kIsSanitized) GTEST_SKIP() << "address sanitizer needs more memory than a limit leaves";
  write("large.pgm", "P5\n30000 30000\n255\n");
  std::filesystem::resize_file(folder() / "large.pgm", 900'000'020);
  EXPECT_EQ(run_limited(1200, "diff large.pgm large.pgm"), 3);
  expect_one_message(read("script.txt"), {"memory ran out", "ulimit -v"});
}

/// The loader itself fails below 600 MB on Debian 12, and below 700 MB on Debian 13, before anything of the program
/// runs.
TEST_F(FaultLimits, MemoryThatIsTooSmallToStartIn_IsOneMessage) {
  if (kIsSanitized) GTEST_SKIP() << "address sanitizer needs more memory than a limit leaves";
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

TEST_F(FaultLimits, RefusedContext_IsOneMessage) {
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
