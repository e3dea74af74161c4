#include "harness/measure/scene_truth.h"

#include <gmock/gmock.h>

#include "harness/scene/mesh_tools.h"
#include "reference/truth/occluders.h"

namespace shadowbench::measure {
namespace {

scene::Scene make_floor_of(float size_m) {
  scene::Scene scene;
  scene.name = "land";
  scene.meshes = {scene::make_plane(glm::vec2(size_m), 1)};
  return scene;
}

/// A map of 8 m and 512 texels.
TEST(WideScene, IsToldWhereRaysStartATenthOfATexelOffSurfaces) {
  constexpr double kTexel_m = 8.0 / 512.0;
  for (const float size : {8.0f, 100.0f, 1000.0f}) EXPECT_EQ(describe_wide_scene(make_floor_of(size), kTexel_m), "");
  EXPECT_THAT(describe_wide_scene(make_floor_of(20e3f), kTexel_m),
              testing::AllOf(testing::HasSubstr("land: the scene is too wide"), testing::HasSubstr(" 0.0191 m off"),
                             testing::HasSubstr(" is 0.0156 m")));
  const float widest = 2.0f * static_cast<float>(0.1 * kTexel_m) / (2.0f * truth::origin_offset(0.5f, 0.5f));
  EXPECT_EQ(describe_wide_scene(make_floor_of(0.99f * widest), kTexel_m), "");
  EXPECT_NE(describe_wide_scene(make_floor_of(1.01f * widest), kTexel_m), "");
}

/// A map of the whole scene is never that fine.
TEST(WideScene, UnderAMapOfAllOfIt_IsNone) {
  constexpr float kSize_m = 1e6f;
  EXPECT_EQ(describe_wide_scene(make_floor_of(kSize_m), double{kSize_m} / 16384.0), "");
}

}  // namespace
}  // namespace shadowbench::measure
