// Screen passes as a filter's file declares them, and what their models share.

#include "filters/screen.h"

#include <gmock/gmock.h>

#include "filters/front_matter.h"

namespace shadowbench::filters {
namespace {

std::string write_filter(const std::string& tables, const std::string& glsl) {
  return "/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"other\"\n" + tables +
         "+++*/\nfloat visibility(Receiver r) { return compare_nearest(r, vec2(0.0), r.depth); }\n" + glsl;
}

constexpr const char* kBlur = "vec2 blur(ScreenInput s) { return load_screen(s, ivec2(0)); }\n";

TEST(ScreenSpec, IsRead_InTheOrderOfTheFile) {
  const FilterSpec spec = parse_filter(
      write_filter(
          "[param.far]\ndefault = 2\nmin = 0\nmax = 64\ntext = \"t\"\n[screen.blur]\nreach = \"far\"\nsteps = 8\n"
          "[screen.after]\n",
          std::string(kBlur) + "vec2 after(ScreenInput s) { return vec2(0.0); }\n"),
      "f.glsl");
  ASSERT_EQ(spec.screens.size(), 2u);
  EXPECT_EQ(spec.screens[0].steps, 8);
  EXPECT_EQ(reach_pixels(spec.screens[0], {{"far", 7.0}}), 7);
  EXPECT_EQ(spec.screens[1], (ScreenSpec{.name = "after", .line = 13}));
  EXPECT_EQ(list_screens(spec, {}).size(), 2u) << "without a parameter 'screen' all are drawn";
}

TEST(ScreenSpec, ChosenByAParameter_IsTheOneDrawn) {
  const FilterSpec spec = parse_filter(
      write_filter("[param.screen]\ndefault = \"none\"\nchoices = [\"none\", \"blur\"]\ntext = \"t\"\n[screen.blur]\n",
                   kBlur),
      "f.glsl");
  EXPECT_TRUE(list_screens(spec, {{"screen", std::string("none")}}).empty());
  EXPECT_EQ(list_screens(spec, {{"screen", std::string("blur")}}).size(), 1u);
}

TEST(ScreenSpec, ThatIsWrong_IsRefusedWithItsLine) {
  struct Case {
    std::string tables, glsl, message;
  };
  const std::string number = "[param.far]\ndefault = 2\nmin = 0\nmax = ";
  for (const Case& each : {
           Case{"[screen.blur]\nreach = 500\n", kBlur, "within 0 .. 64"},
           Case{"[screen.blur]\nreach = -1\n", kBlur, "'reach' must not be negative"},
           Case{"[screen.blur]\nreach = 1.5\n", kBlur, "whole number of pixels"},
           Case{number + "65\ntext = \"t\"\n[screen.blur]\nreach = \"far\"\n", kBlur, "within 0 .. 64"},
           Case{"[screen.blur]\nreach = \"far\"\n", kBlur, "far"},
           Case{"[screen.blur]\nsteps = 9\n", kBlur, "steps"},
           Case{"[screen.blur]\nwidth = 1\n", kBlur, "width"},
           Case{"[screen.blur]\n", "", "lacks 'vec2 blur(ScreenInput s)'"},
           Case{"[screen.visibility]\n", "", "'visibility' is the name of something else"},
           Case{"[param.screen]\ndefault = \"none\"\nchoices = [\"none\"]\ntext = \"t\"\n[screen.blur]\n", kBlur,
                "'screen' has no choice 'blur'"},
       }) {
    SCOPED_TRACE(each.tables);
    try {
      parse_filter(write_filter(each.tables, each.glsl), "f.glsl");
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kFilter);
      EXPECT_THAT(error.message(), ::testing::HasSubstr(each.message));
      EXPECT_THAT(error.where(), ::testing::StartsWith("f.glsl:"));
    }
  }
}

TEST(ScreenPicture, OfLayers_TakesPartWhereAllWereAsked) {
  ScreenPicture picture(2, 1);
  Receiver whole, half;
  whole.pixel = {0, 0};
  whole.layer_share = 0.25f;
  picture.add(whole, {.visibility = 1.0, .screen_value = 4.0});
  whole.layer_share = 0.75f;
  picture.add(whole, {.visibility = 0.0, .bound = 0.1, .excused = true});
  half.pixel = {1, 0};
  half.layer_share = 0.5f;
  picture.add(half, {.visibility = 1.0});
  ASSERT_NE(picture.find({0, 0}), nullptr);
  const ModelResult& result = picture.find({0, 0})->result;
  EXPECT_DOUBLE_EQ(result.visibility, 0.25);
  EXPECT_DOUBLE_EQ(result.screen_value, 1.0);
  EXPECT_DOUBLE_EQ(result.bound, 0.075);
  EXPECT_TRUE(result.excused);
  for (const glm::ivec2 absent : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(2, 0), glm::ivec2(0, 1)})
    EXPECT_EQ(picture.find(absent), nullptr);
}

TEST(NearOnSurface, FallsWithDistance_AndAtSilhouettes) {
  Receiver here, there;
  here.position_ws = there.position_ws = {0.0f, 0.0f, 0.0f};
  EXPECT_EQ(near_on_surface(here, there, 1.0), 1.0);
  there.position_ws.x = 0.5f;
  EXPECT_EQ(near_on_surface(here, there, 1.0), 0.75);
  EXPECT_EQ(near_on_surface(here, there, 0.5), 0.0);
  there.position_ws.y = 0.25f;
  EXPECT_EQ(near_on_surface(here, there, 1.0), 0.0) << "off the plane";
  there.position_ws.y = 0.0f;
  there.normal_ws = {1.0f, 0.0f, 0.0f};
  EXPECT_EQ(near_on_surface(here, there, 1.0), 0.0) << "faces another way";
}

}  // namespace
}  // namespace shadowbench::filters
