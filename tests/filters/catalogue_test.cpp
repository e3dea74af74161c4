#include "filters/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "filters/base/error.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

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
    EXPECT_NE(make_model(spec.id), nullptr) << spec.id;
    EXPECT_FALSE(spec.source.empty()) << spec.id;
  }
  EXPECT_EQ(built_in().filters().front().id, "none");
}

TEST(Catalogue, EveryModel_HasItsFilter) {
  for (const ModelEntry& entry : model_table()) EXPECT_NO_THROW(built_in().find(entry.id)) << entry.id;
}

TEST(Requests, Empty_AsksForAll) { EXPECT_EQ(built_in().parse_requests("").size(), built_in().filters().size()); }

TEST(Requests, ParametersBelongToTheFilterBefore) {
  const auto requests = built_in().parse_requests("none,vsm:radius=8,min_variance=1e-4,esm:combine=log");
  ASSERT_EQ(requests.size(), 3u);
  EXPECT_EQ(number(requests[1].values, "radius"), 8.0);
  EXPECT_EQ(number(requests[1].values, "min_variance"), 1e-4);
  EXPECT_EQ(number(requests[1].values, "bleed_reduction"), 0.3);
  EXPECT_EQ(requests[1].label(), "vsm (radius=8, min_variance=0.0001)");
  EXPECT_EQ(text_or(requests[2].values, "combine", ""), "log");
  EXPECT_THAT(requests[1].set_by_user, ElementsAre("radius", "min_variance"));
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
}

TEST(UserFile, WithATakenId_IsRefused) {
  Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  EXPECT_THROW(catalogue.add_user_file(SHADOWBENCH_SOURCE_DIR "/filters/vsm.glsl"), Error);
}

TEST(UserFile, NamedAsTheReportsOwnPictures_IsRefused) {
  const auto copy = std::filesystem::path(::testing::TempDir()) / std::to_string(getpid()) / "truth.glsl";
  std::filesystem::create_directories(copy.parent_path());
  std::filesystem::copy_file(SHADOWBENCH_SOURCE_DIR "/filters/none.glsl", copy);
  Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  EXPECT_THROW(catalogue.add_user_file(copy), Error);
  std::filesystem::remove_all(copy.parent_path());
}

}  // namespace
}  // namespace shadowbench::filters
