#include "harness/view/picture_input.h"

#include "harness/view/view_state.h"
#include "harness/view/workbench.h"
#include "tests/harness/scene/made_scenes.h"
#include "tests/test_files.h"

namespace shadowbench::view {
namespace {

scene::Camera make_camera() { return scene::make_camera({3.0f, 2.0f, 5.0f}, {-0.5f, -0.3f, -0.8f}); }

/// A point as the camera sees it: right, up, ahead.
glm::vec3 see(const scene::Camera& camera, const glm::vec3& point_ws) {
  const glm::vec3 right = glm::normalize(glm::cross(camera.forward_ws, camera.up_ws));
  const glm::vec3 way = point_ws - camera.position_ws;
  return {glm::dot(way, right), glm::dot(way, glm::cross(right, camera.forward_ws)), glm::dot(way, camera.forward_ws)};
}

TEST(Orbit, KeepsThePivotWhereItIsSeen_AndGoesToTheRight) {
  const glm::vec3 pivot(0.5f, 0.2f, -1.0f);
  const scene::Camera before = make_camera(), after = orbit(before, pivot, 0.4f, 0.2f);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(see(before, pivot)[axis], see(after, pivot)[axis], 1e-5f);
  const glm::vec3 right = glm::normalize(glm::cross(before.forward_ws, before.up_ws));
  EXPECT_GT(glm::dot(after.position_ws - before.position_ws, right), 0.5f);
  EXPECT_GT(after.position_ws.y, before.position_ws.y);
  EXPECT_NEAR(glm::length(after.forward_ws), 1.0f, 1e-6f);
}

TEST(Orbit, ThereAndBack_IsWhereItWas) {
  const glm::vec3 pivot(0.5f, 0.2f, -1.0f);
  const scene::Camera before = make_camera(), after = orbit(orbit(before, pivot, 0.4f, 0.2f), pivot, -0.4f, -0.2f);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(before.position_ws[axis], after.position_ws[axis], 1e-4f);
}

TEST(LookAround, StopsBeforeStraightDown_AndDoesNotMove) {
  const scene::Camera after = look_around(make_camera(), 0.3f, -9.0f);
  EXPECT_NEAR(after.forward_ws.y, -std::sin(glm::radians(89.0f)), 1e-5f);
  EXPECT_EQ(after.position_ws, make_camera().position_ws);
}

TEST(Fly, FollowsTheCamerasAxes) {
  const scene::Camera before = make_camera(), after = fly(before, {0.0f, 0.0f, 2.0f});
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(after.position_ws[axis], (before.position_ws + 2.0f * before.forward_ws)[axis], 1e-5f);
}

TEST(Approach, ScalesTheDistance_AndWhatAnOrthographicViewShows) {
  scene::Camera camera = make_camera();
  camera.orthographic_height_m = 4.0f;
  const glm::vec3 pivot(1.0f, 0.0f, 0.0f);
  const scene::Camera after = approach(camera, pivot, 0.5f);
  EXPECT_NEAR(glm::distance(after.position_ws, pivot), 0.5f * glm::distance(camera.position_ws, pivot), 1e-5f);
  EXPECT_FLOAT_EQ(after.orthographic_height_m, 2.0f);
}

TEST(Sky, ALightStandsWhereItIsPut_WhateverItsKind) {
  scene::Spot spot;
  spot.position_ws = {1.0f, 3.0f, 1.0f};
  for (const scene::LightKind& kind : {scene::LightKind(scene::Sun()), scene::LightKind(spot),
                                       scene::LightKind(scene::PointLight{{1.0f, 2.0f, 0.5f}, 0.1f, 1.0f})}) {
    scene::Light light;
    light.kind = kind;
    light = scene::place_in_sky(light, {120.0, 35.0});
    EXPECT_NEAR(find_in_sky(light).azimuth_deg, 120.0, 1e-3);
    EXPECT_NEAR(find_in_sky(light).elevation_deg, 35.0, 1e-3);
    const scene::SkyAngles moved = find_in_sky(move_in_sky(light, 10.0, 70.0));
    EXPECT_NEAR(moved.elevation_deg, 90.0, 0.05);  // no farther than straight above
  }
}

/// Watches a file that is there.
class FileWatchTest : public testing::Test {
 protected:
  FileWatchTest() { watch_.watch({write("a.glsl", "one")}); }

  std::filesystem::path write(const char* name, const char* text) const { return folder_.write(name, text); }
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  const TestFolder folder_;
  FileWatch watch_;
};

TEST_F(FileWatchTest, SeesASave_AReplacement_AndNothingElse) {
  EXPECT_FALSE(watch_.has_changed());
  write("a.glsl", "three");
  EXPECT_TRUE(watch_.has_changed());
  EXPECT_FALSE(watch_.has_changed());
  // Many editors write a new file and rename it.
  write("b", "seven..");
  std::filesystem::rename(path("b"), path("a.glsl"));
  EXPECT_TRUE(watch_.has_changed());
}

TEST_F(FileWatchTest, AFileThatIsGone_IsNoChangeUntilItIsBack) {
  std::filesystem::remove(path("a.glsl"));
  EXPECT_FALSE(watch_.has_changed());
  write("a.glsl", "other");
  EXPECT_TRUE(watch_.has_changed());
}

TEST_F(FileWatchTest, WatchingMore_ForgetsNoChange) {
  write("a.glsl", "three");
  watch_.watch({path("a.glsl"), path("b")});
  EXPECT_TRUE(watch_.has_changed());
}

// What a file of lessons may say.

constexpr const char* kGood =
    "[[lesson]]\n"
    "name = 'a'\n"
    "title = 'A'\n"
    "text = ['One.', 'Two.', 'Three.']\n"
    "scene = 'cubes'\n"
    "left = 'none'\n"
    "right = 'truth'\n"
    "map_size = 64\n"
    "layer = 'error'\n"
    "reading = {place = [0, 0, 0], side = 'right', zoom = 2, content = 'channel 1'}\n";

class LessonsFile : public ::testing::Test {
 protected:
  std::vector<Lesson> read(const std::string& text) const { return read_lessons(folder_.write("lessons.toml", text)); }

  /// What is said of the good file with a line in place of another.
  std::string refuse(const std::string& old_line, const std::string& line) const {
    std::string text = kGood;
    text.replace(text.find(old_line), old_line.size(), line);
    return error_of([&] { read(text); }).what();
  }

 private:
  TestFolder folder_;
};

TEST_F(LessonsFile, Good_IsReadWhole) {
  const std::vector<Lesson> lessons = read(kGood);
  ASSERT_EQ(lessons.size(), 1u);
  EXPECT_EQ(lessons[0].sides[1], "truth");
  EXPECT_EQ(lessons[0].layer, "error");
  EXPECT_EQ(lessons[0].reading.side, 1u);
  EXPECT_EQ(lessons[0].reading.content, "channel 1");
  EXPECT_EQ(lessons[0].settings.fit, "tight");
  EXPECT_TRUE(lessons[0].instead_title.empty());
}

TEST_F(LessonsFile, Bad_IsRefusedWithItsLine) {
  EXPECT_THAT(refuse("'Three.'", ""), AllOf(HasSubstr("lessons.toml:4"), HasSubstr("three sentences")));
  EXPECT_THAT(refuse("layer = 'error'", "layer = 'eror'"), AllOf(HasSubstr("lessons.toml:9"), HasSubstr("error")));
  EXPECT_THAT(refuse("left = ", "lft = "), AllOf(HasSubstr("lessons.toml:6"), HasSubstr("left")));
  EXPECT_THAT(refuse("zoom = 2", "zoom = 0"), HasSubstr("lessons.toml:10"));
  EXPECT_THAT(refuse("'channel 1'", "'chanel 1'"), AllOf(HasSubstr("lessons.toml:10"), HasSubstr("channel 1")));
  EXPECT_THAT(refuse("name = 'a'", ""), HasSubstr("name"));
  EXPECT_THAT(refuse("reading = ", "divider = 0.3 # "), HasSubstr("reading"));
}

}  // namespace
}  // namespace shadowbench::view
