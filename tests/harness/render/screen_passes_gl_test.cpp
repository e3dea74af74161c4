// Screen passes: what a filter's file declares over its own picture.

#include <cmath>

#include "filters/screen.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

class ScreenPassesTest : public ::testing::Test {
 protected:
  ScreenPassesTest() {
    for (const char* file : {"screen_box", "atrous"})
      filters_.add_user_file(std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/user_filters/" + file + ".glsl");
  }

  filters::FilterRequest request(const std::string& text) const { return filters_.parse_requests(text).front(); }

  filters::Catalogue filters_{options::find_resources().filters};
};

/// The mean over a row of up to three receivers, halved twice; background and unlit surfaces stay as they were.
TEST_F(ScreenPassesTest, RunInOrder_OnReceiversAlone) {
  for (const char* scene : {"stack", "avenue"}) {  // the avenue has a map of several layers
    SCOPED_TRACE(scene);
    Bench bench(shared_context(), load_builtin(scene), 256, 160, 90);
    filters::FilterRequest box = request("screen_box"), plain = box;
    plain.spec.screens.clear();
    const std::vector<float> filtered = bench.draw(box), before = bench.draw(plain);
    std::vector<bool> takes_part(filtered.size());
    for (const filters::Receiver& r : bench.receivers(box)) takes_part[bench.index(r)] = true;
    std::size_t edges = 0;
    for (std::size_t i = 0; i < filtered.size(); ++i) {
      if (!takes_part[i]) {
        ASSERT_EQ(filtered[i], before[i]) << i;
        continue;
      }
      float sum = 0.0f, count = 0.0f;
      for (int x = -1; x <= 1; ++x) {
        const auto column = static_cast<int>(i % 160) + x;
        const std::size_t there = i + static_cast<std::size_t>(x + 1) - 1;
        if (column < 0 || column >= 160 || !takes_part[there]) continue;
        sum += before[there];
        count += 1.0f;
      }
      ASSERT_NEAR(filtered[i], 0.25f * sum / count, 1e-6f) << i;
      if (sum > 0.0f && sum < count) ++edges;
    }
    EXPECT_GT(edges, 50u) << "a blur of what is even proves nothing";
  }
}

TEST_F(ScreenPassesTest, Reads_AreCounted_AndWithinTheDeclaredReach) {
  Bench bench(shared_context(), load_builtin("stack"), 256, 160, 90);
  const auto measure = [&](const std::string& text) {
    const filters::FilterRequest filter = request(text);
    render::FilterPasses passes(bench.shaders(), filter, bench.map(), bench.light(filter));
    return passes.measure_cost(bench.shaders(), bench.gbuffer(), bench.map());
  };
  const render::FilterCost near = measure("screen_box");
  EXPECT_NEAR(near.screen.per_receiver, 6.0, 1e-6);  // 3 and 1 of row(), and 1 of halve(), twice
  EXPECT_EQ(near.passes, 2 + 3);
  EXPECT_TRUE(near.screen.exceeded.empty());
  const render::FilterCost far = measure("screen_box:side=3");
  ASSERT_EQ(far.screen.exceeded.size(), 1u);
  EXPECT_EQ(far.screen.exceeded.front(), "'row' reads 3 pixels away, and declares a reach of 1");
  for (const char* text : {"pcss:taps=4,search_taps=4,screen=bilateral", "atrous"}) {
    const render::FilterCost cost = measure(text);
    EXPECT_TRUE(cost.screen.exceeded.empty()) << text;
    EXPECT_GT(cost.screen.per_receiver, 10.0) << text;
  }
  EXPECT_EQ(measure("pcss").screen.per_receiver, 0.0);
  EXPECT_EQ(measure("pcss").passes, 2);
}

TEST_F(ScreenPassesTest, ThatReadsTheMap_OrOneOfTheFilters_IsRefused) {
  Bench bench(shared_context(), load_builtin("stack"), 64, 32, 18);
  for (const char* read : {"load_depth(s.pixel)", "load_copy(s.pixel).x"}) {
    SCOPED_TRACE(read);
    filters::FilterRequest box = request("screen_box");
    box.spec.passes.push_back({.name = "copy", .store = "r32f"});
    box.spec.body.insert(box.spec.body.find("float visibility"),
                         "vec4 copy(PassInput p) { return vec4(load_depth(p.texel)); }\n");
    const std::string result = "return 0.5 * own;";
    box.spec.body.replace(box.spec.body.find(result), result.size(), "return " + std::string(read) + " * own;");
    try {
      bench.draw(box);
      FAIL() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFilter);
      EXPECT_NE(error.message().find("'halve' reads the shadow map"), std::string::npos) << error.message();
      EXPECT_NE(error.where().find("screen_box.glsl:17"), std::string::npos) << error.where();
    }
  }
}

/// Noise goes, and what is the mean of many pixels stays: edges between surfaces, lit and dark pixels.
TEST_F(ScreenPassesTest, OfPcss_TakeNoiseAway) {
  Bench bench(shared_context(), load_builtin("ball"), 1024, 480, 270);
  const std::vector<float> exact = bench.draw(request("pcss:taps=32,search_taps=32"));
  const auto differ = [&](const std::string& text) {
    const std::vector<float> image = bench.draw(request(text));
    double sum = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) sum += std::pow(static_cast<double>(image[i] - exact[i]), 2.0);
    return std::sqrt(sum / static_cast<double>(image.size()));
  };
  EXPECT_LT(differ("pcss:taps=4,search_taps=4,screen=bilateral"), 0.6 * differ("pcss:taps=4,search_taps=4"));
}

}  // namespace
}  // namespace shadowbench::test
