// What is said of a light that no view shows: it works where it is written into the scene.

#include "harness/scene/unseen_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "harness/scene/load.h"
#include "test_files.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A box on a floor, with a sun and a lamp.
std::string write_scene(const std::string& lamp, const std::string& camera = {}) {
  return "title = \"a\"\n" + camera +
         "[[light]]\nname = \"sun\"\nazimuth_deg = 60\nelevation_deg = 40\n"
         "[[light]]\nname = \"lamp\"\ntype = \"point\"\n" +
         lamp +
         "\n[[object]]\nshape = \"plane\"\nsize = [12, 12]\n"
         "[[object]]\nshape = \"box\"\nsize = [2, 2, 2]\ncenter = [0, 1, 0]\n";
}

/// What is said of each light.
std::vector<std::string> list_advice(const std::string& text) {
  const TestFolder folder;
  std::vector<std::string> advice;
  for (const Scene& lit : separate_lights(load_scene(folder.write("a.toml", text))))
    advice.push_back(advise_on_unseen_light(lit, lit.cameras, 16.0 / 9.0));
  return advice;
}

TEST(UnseenLight, ALampInABox_IsLiftedOutOfIt) {
  const auto advice = list_advice(write_scene("position = [0, 1.5, 0]"));
  EXPECT_THAT(advice[0], IsEmpty());
  std::smatch found;
  ASSERT_TRUE(std::regex_search(advice[1], found, std::regex("write into its \\[\\[light\\]\\] (position = .*\\])")))
      << advice[1];
  EXPECT_THAT(list_advice(write_scene(found[1]))[1], IsEmpty());
}

TEST(UnseenLight, AViewThatLooksAway_GetsACameraBesideIt) {
  const std::string away = "[[camera]]\nname = \"up\"\nposition = [0, 5, 0]\ntarget = [0, 9, 0.1]\n",
                    lamp = "position = [2, 3, 0]";
  const std::string advice = list_advice(write_scene(lamp, away))[1];
  ASSERT_THAT(advice, StartsWith("write into its file a [[camera]] with "));
  std::string keys = advice.substr(advice.find("name"));
  keys = std::regex_replace(keys, std::regex(", (?=[a-z])"), "\n");
  const auto again = list_advice(write_scene(lamp, away + "[[camera]]\n" + keys + "\n"));
  EXPECT_THAT(again[1], IsEmpty());
  EXPECT_THAT(again[0], HasSubstr("name = \"sun\", light = \"sun\"")) << "that camera is for the lamp";
}

TEST(UnseenLight, ALitPlaceOfAFewPixels_IsSeen) {
  const std::string far = "[camera]\nposition = [0, 3000, 1]\ntarget = [0, 0, 0]\n";
  EXPECT_THAT(list_advice(write_scene("position = [2, 3, 0]", far)), testing::Each(IsEmpty()));
}

}  // namespace
}  // namespace shadowbench::scene
