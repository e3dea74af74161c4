// Memory that runs out, and OpenGL that is refused: one message each, and nothing written.

#include <array>

#include "harness/gl/context/context.h"
#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

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
    EXPECT_EQ(code, 3) << mebibytes << " " << read_text(folder() / "script.txt");
    expect_one_message(read_text(folder() / "script.txt"), {"large.gltf", "memory ran out", "ulimit -v"});
    EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
  }
  EXPECT_EQ(run_limited(1600, std::string("run --scene cubes") + kRest), 0)
      << "the limit alone is enough to stop a run: " << read_text(folder() / "script.txt");
}

TEST_F(FaultLimits, MemoryThatOtherThingsDoNotFitInto_IsSaidToo) {
  if (kIsSanitized) GTEST_SKIP() << "address sanitizer needs more memory than a limit leaves";
  write("large.pgm", "P5\n30000 30000\n255\n");
  std::filesystem::resize_file(folder() / "large.pgm", 900'000'020);
  EXPECT_EQ(run_limited(1200, "diff large.pgm large.pgm"), 3);
  expect_one_message(read_text(folder() / "script.txt"), {"memory ran out", "ulimit -v"});
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
    const std::string said = read_text(folder() / "script.txt");
    EXPECT_THAT(said, testing::HasSubstr("shadowbench: ")) << mebibytes;
    EXPECT_THAT(said, testing::AnyOf(testing::HasSubstr("ulimit -v"), testing::HasSubstr("not enough memory"))) << said;
    EXPECT_THAT(said, testing::Not(testing::HasSubstr("terminate called"))) << mebibytes;
  }
}

TEST_F(FaultLimits, RefusedContext_IsOneMessage) {
  struct Refusal {
    const char* environment;
    const char* backend;
    const char* word;
  };
  const bool has_osmesa = gl::has_backend(gl::Backend::kOsmesa);
  const std::array refusals = {
      Refusal{"__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null", "egl", "egl: no device"},
      Refusal{"-u DISPLAY -u WAYLAND_DISPLAY", "glfw", "glfw: GLFW does not start"},
      Refusal{"-u WAYLAND_DISPLAY DISPLAY=:9999", "glfw", "glfw: GLFW does not start"},
      Refusal{"MESA_GL_VERSION_OVERRIDE=2.1", "software",
              has_osmesa ? "osmesa: OSMesa gives no OpenGL 4.5 core context" : "egl in software: "},
      Refusal{"MESA_GL_VERSION_OVERRIDE=2.1 __EGL_VENDOR_LIBRARY_FILENAMES=/dev/null DISPLAY=:9999", "auto",
              has_osmesa ? "osmesa: OSMesa gives" : "egl: no device"}};
  for (const Refusal& each : refusals) {
    std::vector<std::string> commands = {"run --scene cubes"};
    if (each.backend == std::string("glfw")) commands.insert(commands.end(), {"bias", "stress", "tune --filters vsm"});
    for (const std::string& command : commands) {
      const std::string line = std::string("env ") + each.environment + " '" SHADOWBENCH_PROGRAM "' " + command +
                               " --out out --gl " + each.backend;
      EXPECT_EQ(run_script("", line), 4) << line;
      expect_one_message(read_text(folder() / "script.txt"), {"no OpenGL 4.5 core context", each.word, "--gl"});
      EXPECT_FALSE(std::filesystem::exists(folder() / "out")) << line;
    }
  }
}

}  // namespace
}  // namespace shadowbench::test
