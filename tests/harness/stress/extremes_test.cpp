// The constructed scene, the judgement of drawings, and what the axes of extremes see without a GL.

#include <gmock/gmock.h>

#include <cmath>

#include "harness/scene/validate.h"
#include "harness/stress/drawn_scene.h"
#include "harness/stress/onset.h"
#include "harness/stress/slab_scene.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

using ::testing::HasSubstr;

TEST(SlabScene, ShadowLiesUnderTheSlab_AndMovesWithTheLight) {
  const SlabSetting down;
  EXPECT_EQ(find_slab_visibility(down, {0.2, 0.0, -0.1}, 0.01), 0.0);
  EXPECT_EQ(find_slab_visibility(down, {1.8, 0.0, 1.8}, 0.01), 1.0);
  EXPECT_EQ(find_slab_visibility(down, {0.2, 1.0, -0.1}, 0.01), 1.0) << "the slab itself";
  // 45 degrees: the slab's shadow, 1 m below it, is 1 m away.
  const SlabSetting leaning{.light_local = {1.0, -1.0, 0.0}};
  EXPECT_EQ(find_slab_visibility(leaning, {1.2, 0.0, -0.1}, 0.01), 0.0);
  EXPECT_EQ(find_slab_visibility(leaning, {0.0, 0.0, -0.1}, 0.01), 1.0);
}

TEST(SlabScene, NearItsEdge_AndOnTheWall_NothingIsSaid) {
  const SlabSetting down;
  const double turn = glm::radians(20.0);
  const glm::dvec3 on_edge(0.2 + 0.75 * std::cos(turn), 0.0, -0.1 - 0.75 * std::sin(turn));
  EXPECT_EQ(find_slab_visibility(down, on_edge, 0.01), std::nullopt);
  EXPECT_EQ(find_slab_visibility(down, on_edge + glm::dvec3(0.05, 0.0, 0.0), 0.01), 1.0);
  EXPECT_EQ(find_slab_visibility(down, {-2.0, 0.6, 0.0}, 0.01), std::nullopt);
  EXPECT_EQ(find_slab_visibility(down, {-2.0, 1.0, 0.0}, 0.01), std::nullopt);
}

TEST(SlabScene, TurnsAsAWhole) {
  const glm::dmat3 turned({0, 1, 0}, {-1, 0, 0}, {0, 0, 1});
  const scene::Scene scene = scene::validate(make_slab_scene({.world_from_local = turned, .wall = true}), "test");
  EXPECT_EQ(-scene::to_light(scene.light, {}), glm::vec3(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(find_slab_visibility({.world_from_local = turned}, turned * glm::dvec3(0.2, 0.0, -0.1), 0.01), 0.0);
  EXPECT_EQ(scene.meshes.size(), 3u);
}

Drawing make_drawing(std::vector<float> visibility) {
  Drawing drawing{std::move(visibility), {}};
  drawing.position.assign(drawing.visibility.size(), glm::vec4(1.0f));
  return drawing;
}

TEST(JudgeDrawing, CountsPixelsThatDiffer) {
  const Drawing expected = make_drawing({0.0f, 1.0f, 1.0f, 0.5f});
  EXPECT_EQ(judge_drawing(make_drawing({0.05f, 1.0f, 0.95f, 0.5f}), expected, 0.25).verdict, Verdict::kOk);
  const Observation one = judge_drawing(make_drawing({0.0f, 1.0f, 0.2f, 0.5f}), expected, 0.1);
  EXPECT_EQ(one.verdict, Verdict::kDegraded);
  EXPECT_EQ(one.measured, 0.25);
  EXPECT_THAT(one.why, HasSubstr("1 darker and 0 brighter"));
  EXPECT_EQ(judge_drawing(make_drawing({0.0f, 1.0f, 0.2f, 0.5f}), expected, 0.25).verdict, Verdict::kOk);
}

TEST(JudgeDrawing, NotFinite_AllLit_OrAllDark_IsBroken) {
  const Drawing expected = make_drawing({0.0f, 1.0f});
  EXPECT_THAT(judge_drawing(make_drawing({0.0f, NAN}), expected, 1.0).why, HasSubstr("1 of 2"));
  EXPECT_THAT(judge_drawing(make_drawing({1.0f, 1.0f}), expected, 1.0).why, HasSubstr("lit"));
  EXPECT_THAT(judge_drawing(make_drawing({0.0f, 0.0f}), expected, 1.0).why, HasSubstr("dark"));
  Drawing nothing = make_drawing({1.0f, 1.0f});
  nothing.position.assign(2, glm::vec4(0.0f));
  EXPECT_EQ(judge_drawing(nothing, expected, 1.0).verdict, Verdict::kBroken) << "background alone";
  EXPECT_EQ(judge_drawing(make_drawing({1.0f, 1.0f}), make_drawing({1.0f, 1.0f}), 0.0).verdict, Verdict::kOk);
}

TEST(Extremes, WithoutAGl_GlCasesSayThatThereIsNone) {
  for (const char* id : {"position", "scale", "map-edge", "map-size", "light-direction", "poisoned-input"}) {
    for (const Case& item : choose_axes(id)[0].make_cases(make_inputs("none,vsm"))) {
      EXPECT_EQ(item.not_available.find("no GL") != std::string::npos, item.level == Level::kGl)
          << id << " " << item.variant;
    }
  }
}

TEST(PoisonedInput, Scenes_AreRefused_AndModelsKeepPoisonWithinTheKernel) {
  const Axis axis = choose_axes("poisoned-input")[0];
  int refused = 0, spread = 0;
  for (const Case& item : axis.make_cases(make_inputs(""))) {
    if (item.level == Level::kGl) continue;
    const records::StressCase found = find_onsets(item, axis);
    EXPECT_FALSE(found.broken) << item.filter << " " << item.variant << ": " << found.broken->why;
    if (item.level == Level::kModel && found.degraded) ++spread;
    for (const std::string& note : found.notes)
      refused += note.find("is refused as the scene is loaded") != std::string::npos;
  }
  EXPECT_EQ(refused, 2);
  EXPECT_GT(spread, 0) << "the poison does nothing, so nothing was shown";
}

}  // namespace
}  // namespace shadowbench::stress
