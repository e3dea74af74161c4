#include "harness/gpu/null_device.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "harness/gpu/facts_request.h"
#include "harness/gpu/gpu.h"
#include "tests/test_files.h"

namespace shadowbench::gpu {
namespace {

// What RADV says of shaders whose machine code is known to differ in one thing. Skipped, with the reason, where there
// is no RADV.

/// Whether a process lives through asking the driver for a family: RADV ends those that ask for one that it has not.
bool is_known(const std::string& family) {
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    error_of([&] { NullDevice device(family); });  // said by the test, in its own process
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
  EXPECT_THAT(error_of([&] { facts("result = gl_DepthRange.near;"); }),
              is_error(ErrorKind::kFilter, "(program):9: Vulkan refuses this GLSL"));
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

// The files between a run and the process that compiles for it.

class FactsRequests : public ::testing::Test {
 protected:
  std::filesystem::path file(const char* name) const { return folder_.path() / name; }

  FactsRequest request() const {
    const auto shader = [](const std::string& code) {
      return PassSource{{"#version 450 core\nlayout(location = 0) out float r;\nvoid main() { " + code + " }\n",
                         {"(program)", "mine.glsl"}},
                        "r32f"};
    };
    return {"NAVI21",
            file("cache"),
            {shader("r = exp(gl_FragCoord.x) * gl_FragCoord.y;"), shader("r = nothing;"), shader("r = 1.0;")}};
  }

  /// What answers the request; skips the test where there is no RADV.
  std::vector<FactsAnswer> answer() {
    std::filesystem::remove(file("answers"));
    write_request(file("request"), request());
    answer_request(file("request"), file("answers"));
    return read_answers(file("answers"));
  }

  const TestFolder folder_;
};

TEST_F(FactsRequests, AreAnsweredInTheirOrder_AndKept) {
  std::vector<FactsAnswer> first;
  try {
    first = answer();
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  ASSERT_EQ(first.size(), 3u);
  EXPECT_EQ(first[0].refused, "");
  EXPECT_GT(first[0].facts.instructions, first[2].facts.instructions);
  EXPECT_THAT(first[1].refused, HasSubstr("'nothing'"));
  // What was kept is taken: a number that nobody would compile comes back; what was damaged is made again.
  std::vector<std::filesystem::path> kept;
  for (const auto& entry : std::filesystem::directory_iterator(file("cache") / "gpu")) kept.push_back(entry.path());
  ASSERT_EQ(kept.size(), 2u);
  for (const auto& each : kept) {
    const std::string text = read_text(each);
    const std::size_t at = text.find("\"instructions\":") + 15;
    std::ofstream(each) << text.substr(0, at) << "98765" << text.substr(text.find_first_of(",}", at));
  }
  EXPECT_EQ(answer()[0].facts.instructions, 98765);
  for (const auto& each : kept) std::ofstream(each) << "{\"instructions\": \"many\"}";
  EXPECT_EQ(answer()[0].facts, first[0].facts);
}

TEST_F(FactsRequests, AnAnswerThatBreaksOff_EndsTheList) {
  std::ofstream(file("answers")) << "{\"refused\":\"a\"}\n{\"refused\":\"b\"}\n{\"refu";
  EXPECT_EQ(read_answers(file("answers")).size(), 2u);
  EXPECT_TRUE(read_answers(file("nowhere")).empty());
}

TEST_F(FactsRequests, ARequestThatIsNone_IsRefused) {
  std::ofstream(file("request")) << "{}";
  EXPECT_THROW(answer_request(file("request"), file("answers")), Error);
}

// How textures are read, and loops, in a listing of machine code.

records::ShaderFacts count(const char* listing) {
  records::ShaderFacts facts;
  count_reads(listing, facts);
  return facts;
}

TEST(MachineCode, ReadsAreOfTheirKind) {
  const records::ShaderFacts facts = count(
      "BB0:\n"
      "\timage_load v[0:3], v0, s[8:15] dmask:0xf unorm              ; f0001f00 00020000\n"
      "\timage_load_mip v[0:3], v[0:2], s[8:15] dmask:0xf            ; f0001f00 00020000\n"
      "\timage_sample v0, v[2:3], s[8:15], s[16:19] dmask:0x1         ; f0a00100 00820002\n"
      "\timage_sample_lz v0, v[2:3], s[8:15], s[16:19] dmask:0x1      ; f0a00100 00820002\n"
      "\timage_sample_l v0, v[2:3], s[8:15], s[16:19] dmask:0x1       ; f0a00100 00820002\n"
      "\timage_sample_c v0, v[2:3], s[8:15], s[16:19] dmask:0x1       ; f0a00100 00820002\n"
      "\timage_sample_c_lz_o v0, v[2:3], s[8:15], s[16:19] dmask:0x1  ; f0a00100 00820002\n"
      "\timage_gather4_c_lz v[0:3], v[2:4], s[8:15], s[16:19]         ; f0a00100 00820002\n"
      "\timage_gather4_lz v[0:3], v[2:4], s[8:15], s[16:19]           ; f0a00100 00820002\n"
      "\timage_gather4_cl v[0:3], v[2:4], s[8:15], s[16:19]           ; f0a00100 00820002\n"
      "\tbuffer_load_dword v0, off, s[0:3], 0                         ; e0500000 80000000\n"
      "\ts_endpgm                                                     ; bf810000\n");
  EXPECT_EQ(facts.loads, 2);
  EXPECT_EQ(facts.samples, 3);
  EXPECT_EQ(facts.compares, 2);
  EXPECT_EQ(facts.gathers, 3);
  EXPECT_EQ(facts.reads(), 10);
  EXPECT_EQ(facts.loops, 0);
}

TEST(MachineCode, ALoopIsABlockThatBranchesLeadBackTo) {
  const records::ShaderFacts facts = count(
      "BB0:\n\ts_cbranch_execz BB6   ; bf880013\n"
      "BB1:\n\tv_add_f32 v0, v1, v2  ; 00\n"
      "BB2:\n\ts_cbranch_scc1 BB1    ; bf85\n"
      "BB3:\n\ts_branch BB1          ; bf82\n"
      "BB4:\n\ts_cbranch_vccnz BB4   ; bf87\n"
      "BB6:\n\ts_endpgm              ; bf81\n");
  EXPECT_EQ(facts.loops, 2);  // two branches lead back to BB1, one to BB4, and one forward
}

TEST(MachineCode, TheCompilersLastStep_HasResultsFirstAndNamesTheHeadsOfLoops) {
  const records::ShaderFacts facts = count(
      "After Spilling:\nACO shader stage: fragment_fs\nBB0\n"
      "/* logical preds: / linear preds: / kind: uniform, top-level, loop-preheader, */\n"
      "\t v1: %12 = image_sample_c (kill)%5, (kill)%7,  v1: undef, (kill)%37 1d\n"
      "\t s2: %40 = p_branch BB1\nBB1\n"
      "/* logical preds: BB0, BB2, / linear preds: BB0, BB2, / kind: uniform, loop-header, */\n"
      "\t v4: %20,  v1: %21 = image_load %5, %6 2d\n"
      "\ts_cbranch_scc1 BB1\n"
      "\ts_endpgm\n");
  EXPECT_EQ(facts.compares, 1);
  EXPECT_EQ(facts.loads, 1);
  EXPECT_EQ(facts.loops, 1);
}

TEST(MachineCode, NothingIsNothing) { EXPECT_EQ(count(""), records::ShaderFacts()); }

}  // namespace
}  // namespace shadowbench::gpu
