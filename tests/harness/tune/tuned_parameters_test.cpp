#include <gmock/gmock.h>

#include <fstream>

#include "base/error.h"
#include "harness/options/options.h"
#include "harness/tune/tune_filters.h"
#include "tests/test_files.h"

namespace shadowbench::tune {
namespace {

using ::testing::HasSubstr;

class TunedParameters : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const { return folder_.write("tuned.json", text); }

  /// A file with these entries as its filters.
  std::filesystem::path write_filters(const std::string& filters) const {
    return write(R"({"schema_version": 2, "metric": "rmse", "map_size": 1024, "filters": [)" + filters + "]}");
  }

  /// The values of the first request after the file was applied.
  filters::FilterRequest apply(const std::string& requests, const std::filesystem::path& file) {
    auto parsed = catalogue_.parse_requests(requests);
    notes_ = apply_tuned(parsed, catalogue_, file, {1024}, {{}});
    return parsed.front();
  }

  void expect_refusal(const std::filesystem::path& file, const std::string& words) {
    const Error error = error_of([&] { apply("vsm", file); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput) << words;
    EXPECT_THAT(error.what(), ::testing::AllOf(HasSubstr(words), HasSubstr("tuned.json")));
  }

  TestFolder folder_;
  filters::Catalogue catalogue_{options::find_resources().filters};
  std::vector<std::string> notes_;
};

TEST_F(TunedParameters, AreTaken_AndShownByTheLabel) {
  const auto file = write_filters(
      R"({"id": "vsm", "fit": "tight", "params": {"radius": 2, "min_variance": 1e-6, "store": "rg32f"}})");
  const filters::FilterRequest request = apply("vsm", file);
  EXPECT_EQ(filters::number(request.values, "radius"), 2.0);
  EXPECT_EQ(filters::number(request.values, "min_variance"), 1e-6);
  EXPECT_EQ(filters::number(request.values, "bleed_reduction"), 0.3);  // not in the file
  EXPECT_EQ(request.label(), "vsm (min_variance=1e-06, radius=2)");
  EXPECT_TRUE(notes_.empty());
}

TEST_F(TunedParameters, YieldToTheCommandLine) {
  const filters::FilterRequest request = apply(
      "vsm:radius=9", write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": 2, "min_variance": 1e-6}})"));
  EXPECT_EQ(filters::number(request.values, "radius"), 9.0);
  EXPECT_EQ(filters::number(request.values, "min_variance"), 1e-6);
}

TEST_F(TunedParameters, TakeThePlaceOfAWidthsRadius) {
  const filters::FilterRequest request =
      apply("vsm:width=medium", write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": 2}})"));
  EXPECT_EQ(filters::number(request.values, "radius"), 2.0);
  EXPECT_EQ(request.label(), "vsm (radius=2)");
}

TEST_F(TunedParameters, LeaveAPresetTheParametersOfItsEngine) {
  const auto file = write_filters(R"({"id": "poisson", "fit": "tight", "params": {"bail": "agree"}})");
  EXPECT_EQ(apply("@godot", file).values, catalogue_.parse_requests("@godot").front().values);
  EXPECT_TRUE(notes_.empty());
  EXPECT_EQ(filters::text_or(apply("poisson", file).values, "bail", ""), "agree");
}

TEST_F(TunedParameters, OfOtherFilters_LeaveTheDefaults_WithANote) {
  const filters::FilterRequest request =
      apply("esm,none", write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": 2}})"));
  EXPECT_EQ(request.values, filters::default_values(request.spec));
  ASSERT_EQ(notes_.size(), 1u);  // 'none' has no parameters: nothing to say
  EXPECT_THAT(notes_.front(), HasSubstr("no parameters for esm"));
}

TEST_F(TunedParameters, OfAnotherMapSize_AreTakenWithANote) {
  auto requests = catalogue_.parse_requests("vsm");
  const auto notes =
      apply_tuned(requests, catalogue_, write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": 2}})"),
                  {512, 1024}, {{}});
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes.front(), HasSubstr("1024 texels, this run draws 512"));
}

TEST_F(TunedParameters, OfAnotherFit_AreTakenWithANote) {
  auto requests = catalogue_.parse_requests("vsm");
  const auto file = write_filters(R"({"id": "vsm", "params": {"radius": 2}, "fit": "view"})");
  EXPECT_THAT(
      apply_tuned(requests, catalogue_, file, {1024}, {{}}),
      ::testing::ElementsAre(HasSubstr("tuned for vsm (radius=2) under --fit view, which this run does not draw")));
  EXPECT_THAT(apply_tuned(requests, catalogue_, file, {1024}, {{}, {scene::FitMode::kView, {}}}), ::testing::IsEmpty());
}

TEST_F(TunedParameters, BadFiles_AreRefusedWithTheField) {
  expect_refusal(folder_.path() / "no" / "tuned.json", "cannot be read");
  expect_refusal(write(""), "not JSON");
  expect_refusal(write(R"({"schema_version": 2, "met)"), "cut off");
  expect_refusal(write("[]"), "'schema_version' is missing");
  expect_refusal(write("{}"), "'schema_version' is missing");
  expect_refusal(write(R"({"schema_version": 1})"), "schema_version is 1, and this program reads 2");
  expect_refusal(write(R"({"schema_version": 2, "metric": "rmse", "map_size": "big", "filters": []})"),
                 "'map_size' holds \"big\"");
  expect_refusal(write(R"({"schema_version": 2, "metric": "rmse", "map_size": 64, "filters": {}})"),
                 "'filters' must be a list");
  expect_refusal(write_filters(R"({"id": "vsn", "fit": "tight", "params": {}})"),
                 "filters[0].id: unknown filter 'vsn'; did you mean 'vsm'?");
  expect_refusal(write_filters(R"({"id": "vsm"})"), "'filters[0].params' is missing");
  expect_refusal(write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radios": 2}})"),
                 "filters[0].params.radios: filter 'vsm' has no parameter 'radios'; did you mean 'radius'?");
  expect_refusal(write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": 65}})"),
                 "filters[0].params.radius: vsm:radius=65 is out of range");
  expect_refusal(write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": 2.5}})"),
                 "must be a whole number");
  expect_refusal(write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": "wide"}})"),
                 "filters[0].params.radius: vsm:radius='wide' is not a finite number");
  expect_refusal(write_filters(R"({"id": "vsm", "fit": "tight", "params": {"radius": [2]}})"),
                 "'filters[0].params' holds {\"radius\":[2]}");
  expect_refusal(write_filters(R"({"id": "vsm", "fit": "tight", "params": {"store": "rgb"}})"),
                 "filters[0].params.store");
  expect_refusal(
      write_filters(R"({"id": "vsm", "fit": "tight", "params": {}}, {"id": "vsm", "fit": "tight", "params": {}})"),
      "filters[1].id names 'vsm' a second time");
  expect_refusal(
      write_filters(
          R"({"id": "none", "fit": "tight", "params": {}}, {"id": "esm", "fit": "tight", "params": {"c": 0}})"),
      "filters[1].params.c");  // though not requested
}

}  // namespace
}  // namespace shadowbench::tune
