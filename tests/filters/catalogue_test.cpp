#include "filters/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/error.h"
#include "filters/kernel_width.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::UnorderedElementsAre;

const Catalogue& built_in() {
  static const Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  return catalogue;
}

void expect_usage_error(const std::string& text, const std::string& words) {
  try {
    built_in().parse_requests(text);
    ADD_FAILURE() << "accepted: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_THAT(error.message(), HasSubstr(words));
  }
}

TEST(Catalogue, EveryBuiltInFilter_HasAModelAndASource) {
  for (const FilterSpec& spec : built_in().filters()) {
    EXPECT_NE(make_model(spec), nullptr) << spec.id;
    EXPECT_FALSE(spec.source.empty()) << spec.id;
  }
  EXPECT_EQ(built_in().filters().front().id, "none");
}

TEST(Catalogue, EveryModel_HasItsFilter) {
  for (const ModelEntry& entry : model_table()) EXPECT_NO_THROW(built_in().find(entry.id)) << entry.id;
}

std::vector<std::string> ids_of(const std::string& text) {
  std::vector<std::string> ids;
  for (const FilterRequest& request : built_in().parse_requests(text)) ids.push_back(request.spec.id);
  return ids;
}

TEST(Requests, AllAreThoseThatAreNotForTeaching_Empty_AsksForThem) {
  EXPECT_THAT(ids_of("teaching"), UnorderedElementsAre("box3x3", "teach4x4", "teach_evsm"));
  EXPECT_EQ(ids_of(""), ids_of("all"));
  EXPECT_THAT(ids_of("all"), IsSupersetOf({"none", "box4x4", "vsm"}));
  EXPECT_EQ(ids_of("all,teaching").size(), built_in().filters().size());
  EXPECT_THAT(ids_of("teach4x4"), ElementsAre("teach4x4")) << "named, it is drawn";
}

TEST(Requests, AWidth_IsItsRadius) {
  const auto requests = built_in().parse_requests("vsm:width=medium,bleed_reduction=0.2,poisson:width=1.2");
  ASSERT_EQ(requests.size(), 2u);
  EXPECT_EQ(requests[0].label(), "vsm (bleed_reduction=0.2, radius=1)");
  EXPECT_EQ(requests[0].width, "medium");
  EXPECT_EQ(requests[1].label(), "poisson (radius=2.257)");
}

TEST(Requests, AWidth_CountsWithTheOtherParameters) {
  // Read with the nearest texel, a kernel is narrower: 0.54 texels with a radius of 1, 1.00 with 2.
  for (const char* text : {"esm:width=0.78,combine=log", "esm:combine=log,width=0.78"})
    EXPECT_EQ(number(built_in().parse_requests(text).front().values, "radius"), 2.0) << text;
  EXPECT_EQ(number(built_in().parse_requests("esm:width=0.78").front().values, "radius"), 1.0);
}

TEST(Requests, ParametersBelongToTheFilterBefore) {
  const auto requests = built_in().parse_requests("none,vsm:radius=8,min_variance=1e-4,esm:combine=log");
  ASSERT_EQ(requests.size(), 3u);
  EXPECT_EQ(number(requests[1].values, "radius"), 8.0);
  EXPECT_EQ(number(requests[1].values, "min_variance"), 1e-4);
  EXPECT_EQ(number(requests[1].values, "bleed_reduction"), 0.3);
  EXPECT_EQ(requests[1].label(), "vsm (min_variance=0.0001, radius=8)");
  EXPECT_EQ(text_or(requests[2].values, "combine", ""), "log");
  EXPECT_THAT(requests[1].set_by_user, ElementsAre("min_variance", "radius"));
}

TEST(Requests, Mistakes_AreNamed) {
  expect_usage_error("pcf2x3", "did you mean 'pcf2x2'");
  expect_usage_error("vsm:radus=3", "did you mean 'radius'");
  expect_usage_error("vsm:radius=65", "0 .. 64 texels");
  expect_usage_error("vsm:radius=2.5", "whole number");
  expect_usage_error("vsm:radius=inf", "finite");
  expect_usage_error("vsm:radius=3x", "finite");
  expect_usage_error("vsm:radius", "PARAM=VALUE");
  expect_usage_error("radius=3", "before any filter");
  expect_usage_error("none,,vsm", "empty filter name");
  expect_usage_error("none:radius=3", "no parameter 'radius'");
  expect_usage_error("esm:combine=logs", "linear, log");
  expect_usage_error("vsm:width=40", "choose a class (sharp, medium, soft, light) or 0.408 .. 28.3 texels");
  expect_usage_error("vsm:width=0.2", "0.408 .. 28.3 texels");
  expect_usage_error("vsm:width=-1", "0.408 .. 28.3 texels");
  expect_usage_error("vsm:width=nan", "no number of texels");
  expect_usage_error("vsm:width=medum", "did you mean 'medium'");
  expect_usage_error("tent3x3:width=medium", "no radius that a width could set; its kernel is 0.645 texels wide");
  expect_usage_error("vsm:radius=2,width=soft", "sets 'radius' and 'width'");
}

TEST(SetWidths, ReachWhatWasToldNoneAndHasAChoice) {
  const Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  const std::string text = "none,vsm,vsm:radius=6,esm:width=medium,@godot,pcss";
  std::vector<FilterRequest> soft = catalogue.parse_requests(text), light = soft;
  const FilterRequest preset = soft[4];
  set_widths(soft, "soft");
  EXPECT_EQ(number(soft[1].values, "radius"), 3.0);
  EXPECT_EQ(number(soft[2].values, "radius"), 6.0);
  EXPECT_EQ(number(soft[3].values, "radius"), 1.0);
  EXPECT_EQ(soft[4].values, preset.values);

  set_widths(light, std::string(kLightWidth));
  for (FilterRequest& each : light) each.take_light_width(5.0);
  const auto is_of_light = [](const FilterRequest& each) { return each.width == kLightWidth; };
  EXPECT_EQ(number(light[1].values, "radius"), 11.0);
  EXPECT_EQ(*light[1].param_by_light(), "radius");
  EXPECT_EQ(number(light[2].values, "radius"), 6.0);
  EXPECT_FALSE(is_of_light(light[2]));
  EXPECT_EQ(number(light[3].values, "radius"), 1.0);
  EXPECT_EQ(light[4].values, preset.values);
  for (const std::size_t fixed : {0u, 4u, 5u}) {
    EXPECT_TRUE(is_of_light(light[fixed])) << fixed;
    EXPECT_EQ(light[fixed].param_by_light(), nullptr) << fixed;
  }
}

TEST(SetWidths, OneByTheLight_IsNotTheFilterWithThatRadius) {
  const Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  const auto requests = catalogue.parse_requests("vsm,vsm:width=light");
  EXPECT_EQ(requests[0].values, requests[1].values) << "the light is not asked yet";
  EXPECT_FALSE(is_same(requests[0], requests[1]));
}

TEST(UserFile, WithATakenId_IsRefused) {
  Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  EXPECT_THROW(catalogue.add_user_file(SHADOWBENCH_SOURCE_DIR "/filters/vsm.glsl"), Error);
}

TEST(UserFile, NamedAsAWordWithAMeaning_IsRefused) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / std::to_string(getpid());
  std::filesystem::create_directories(folder);
  for (const char* name : {"truth.glsl", "all.glsl", "teaching.glsl"}) {
    std::filesystem::copy_file(SHADOWBENCH_SOURCE_DIR "/filters/none.glsl", folder / name);
    Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
    EXPECT_THROW(catalogue.add_user_file(folder / name), Error) << name;
  }
  std::filesystem::remove_all(folder);
}

TEST(UserFile, HasNoWidth) {
  Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  catalogue.add_user_file(SHADOWBENCH_SOURCE_DIR "/tests/user_filters/nine_compares.glsl");
  const FilterRequest request = catalogue.parse_requests("nine_compares").front();
  EXPECT_EQ(find_kernel_sigma(request.spec, request.values), std::nullopt);
}

}  // namespace
}  // namespace shadowbench::filters
