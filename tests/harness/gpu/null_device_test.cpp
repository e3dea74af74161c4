// What RADV says of shaders whose machine code is known to differ in one thing. Skipped, with the reason, where there
// is no RADV.

#include "harness/gpu/null_device.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "base/error.h"
#include "harness/gpu/gpu.h"

namespace shadowbench::gpu {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Whether a process lives through asking the driver for a family: RADV ends those that ask for one that it has not.
bool is_known(const std::string& family) {
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    try {
      NullDevice device(family);
    } catch (const Error&) {
      // Said by the test, in its own process.
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status);
}

class NullDevices : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!is_known(GetParam())) GTEST_SKIP() << "this machine's driver does not know " << GetParam();
    try {
      device_ = std::make_unique<NullDevice>(GetParam());
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }

  /// The facts of a fragment shader with this code in its main().
  records::ShaderFacts facts(const std::string& code) {
    const std::string text = fmt::format(
        "#version 450 core\n"
        "layout(binding = 0) uniform sampler2D image;\n"
        "layout(binding = 1) uniform sampler2DShadow map;\n"
        "uniform int turns;\n"
        "uniform vec2 step;\n"
        "in vec2 v_uv;\n"
        "layout(location = 0) out float result;\n"
        "void main() {{\n{}\n}}\n",
        code);
    return device_->compile({text, {"(program)"}}, "r32f");
  }

  std::unique_ptr<NullDevice> device_;
};

TEST_P(NullDevices, CompileTheSameTwice) {
  const std::string code = "result = texture(image, v_uv).r * exp(v_uv.x);";
  EXPECT_EQ(facts(code), facts(code));
  NullDevice other(GetParam());
  EXPECT_EQ(other.driver(), device_->driver());
}

TEST_P(NullDevices, OneMoreReadIsOneMoreInstruction) {
  const records::ShaderFacts one = facts("result = texture(map, vec3(v_uv, 0.5));");
  EXPECT_EQ(one.compares, 1);
  EXPECT_EQ(one.samples + one.gathers + one.loads + one.loops, 0);
  const records::ShaderFacts two =
      facts("result = texture(map, vec3(v_uv, 0.5)) + texture(map, vec3(v_uv + step, 0.5));");
  EXPECT_EQ(two.compares, 2);
  EXPECT_GT(two.instructions, one.instructions);
  EXPECT_EQ(facts("result = texture(image, v_uv).r;").samples, 1);
  EXPECT_EQ(facts("result = textureGather(image, v_uv).r;").gathers, 1);
  EXPECT_EQ(facts("result = texelFetch(image, ivec2(v_uv), 0).r;").loads, 1);
}

TEST_P(NullDevices, AnUnrolledLoopHasAllItsTaps) {
  for (const int taps : {2, 5, 9}) {
    const records::ShaderFacts unrolled = facts(fmt::format(
        "result = 0.0; for (int i = 0; i < {}; ++i) result += texture(map, vec3(v_uv + float(i) * step, 0.5));", taps));
    EXPECT_EQ(unrolled.compares, taps);
    EXPECT_EQ(unrolled.loops, 0);
  }
}

TEST_P(NullDevices, ALoopOfUnknownTurnsIsALoop) {
  const records::ShaderFacts looped =
      facts("result = 0.0; for (int i = 0; i < turns; ++i) result += texture(map, vec3(v_uv + float(i) * step, 0.5));");
  EXPECT_GE(looped.compares, 1);
  EXPECT_EQ(looped.loops, 1);
}

TEST_P(NullDevices, RegistersThatDoNotFitSpill) {
  EXPECT_EQ(facts("result = texture(image, v_uv).r;").spilled_registers, 0);
  // So many values that are all needed until the last of them is known; arrays would go to memory at once.
  constexpr int kValues = 300;
  std::string code, sum, odd;
  for (int i = 0; i < kValues; ++i) {
    code += fmt::format("float v{0} = texture(image, v_uv + float({0}) * step).r;\n", i);
    sum += fmt::format("mean += v{};\n", i);
    odd += fmt::format("odd += sin(v{} * mean) * v{};\n", i, kValues - 1 - i);
  }
  const records::ShaderFacts wide = facts(code + "float mean = 0.0, odd = 0.0;\n" + sum + odd + "result = odd;");
  EXPECT_GT(wide.spilled_registers, 0);
  EXPECT_GT(wide.scratch_bytes, 0);
  EXPECT_GT(wide.vector_registers, 128);
}

TEST_P(NullDevices, RefuseWhatVulkanHasNot_WithTheLine) {
  try {
    facts("result = gl_DepthRange.near;");
    FAIL() << "compiled";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFilter);
    EXPECT_THAT(error.what(), HasSubstr("(program):9: Vulkan refuses this GLSL"));
  }
}

std::vector<std::string> list_families() {
  std::vector<std::string> families;
  for (const Gpu& gpu : load_gpus(SHADOWBENCH_SOURCE_DIR "/data/gpus"))
    families.insert(families.end(), gpu.families.begin(), gpu.families.end());
  return families;
}

INSTANTIATE_TEST_SUITE_P(Shipped, NullDevices, ::testing::ValuesIn(list_families()),
                         [](const auto& family) { return family.param; });

// RADV ends the process: this is why passes are compiled in one that can be spared.
TEST(NullDeviceDeathTest, AFamilyThatTheDriverDoesNotKnow) {
  const auto make = [] {
    try {
      NullDevice device("NAVI99");
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      std::abort();
    }
  };
  EXPECT_EXIT(make(), ::testing::KilledBySignal(SIGABRT), "NAVI99");
}

}  // namespace
}  // namespace shadowbench::gpu
