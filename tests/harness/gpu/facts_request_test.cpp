// The files between a run and the process that compiles for it.

#include "harness/gpu/facts_request.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/files.h"

namespace shadowbench::gpu {
namespace {

using ::testing::HasSubstr;

class FactsRequests : public ::testing::Test {
 protected:
  FactsRequests() { std::filesystem::create_directories(folder_.path()); }

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

  ScratchFolder folder_{std::filesystem::temp_directory_path() / ("shadowbench.facts." + std::to_string(getpid()))};
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
    std::ifstream stream(each);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
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

}  // namespace
}  // namespace shadowbench::gpu
