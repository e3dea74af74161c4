#include "report/records/gpu_times.h"

#include "report/pages/tune_page.h"
#include "report/records/tuned_record.h"
#include "tests/report/pages/answer.h"
#include "tests/test_files.h"

namespace shadowbench::records {
namespace {

// Times of a browser's GPU in place of a run's.

constexpr const char* kFilter = R"({"median": 2, "interval": [1.5, 2.5], "rounds": 11})";

class GpuTimesTest : public ::testing::Test {
 protected:
  const TestFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "gpu-times.json";

  GpuTimes read(const std::string& text) const { return read_gpu_times(folder_.write("gpu-times.json", text)); }

  static std::string write(const std::string& map, const std::string& prefilter, const std::string& key = "a") {
    return R"({"schema": "shadowbench gpu-times 1", "renderer": "A GPU", "isSoftware": false, "cells": {")" + key +
           R"(": {"map": )" + map + R"(, "prefilter": )" + prefilter + R"(, "filter": )" + kFilter + "}}}";
  }

  std::string refusal_of(const std::string& text) const {
    const Error error = error_of([&] { read(text); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.where(), file_.string());
    return error.message();
  }
};

TEST_F(GpuTimesTest, AFrameIsTheSumOfItsParts_AndACellThatWasNotTimedHasNoTime) {
  const GpuTimes times = read(
      write(R"({"median": 1, "interval": null, "rounds": 9})", R"({"median": 4, "interval": [3, 6], "rounds": 10})"));
  Results results;
  results.cells.resize(2);
  results.cells[0].key = "a";
  results.cells[1].key = "b";
  results.cells[1].time_ms.lookup = Quartiles{};
  apply_gpu_times(results, times);
  EXPECT_EQ(results.run.gl.renderer, "A GPU");
  const TimeRecord& timed = results.cells[0].time_ms;
  EXPECT_DOUBLE_EQ(timed.moving->median, 7.0);
  EXPECT_DOUBLE_EQ(timed.moving->ci95.low, 5.5);
  EXPECT_DOUBLE_EQ(timed.moving->ci95.high, 9.5);
  EXPECT_EQ(timed.moving->n, 9);
  EXPECT_DOUBLE_EQ(timed.static_light->median, 2.0);
  EXPECT_FALSE(results.cells[1].time_ms.lookup);
  EXPECT_EQ(results.cells[1].absent.at("time_ms"), "A GPU did not time it");
}

TEST_F(GpuTimesTest, WhatIsNoFileOfTimesIsRefused) {
  EXPECT_THAT(refusal_of("{"), HasSubstr("not complete JSON"));
  EXPECT_THAT(refusal_of("[]"), HasSubstr("schema"));
  EXPECT_THAT(refusal_of(R"({"schema": "another"})"), HasSubstr("schema is not \"shadowbench gpu-times 1\""));
  EXPECT_THAT(refusal_of(R"({"schema": "shadowbench gpu-times 1"})"), HasSubstr("no renderer"));
  EXPECT_THAT(refusal_of(write("7", "null")), HasSubstr("of the cell a is no time"));
  EXPECT_THAT(refusal_of(write(R"({"median": 1e10, "interval": null, "rounds": 9})", "null")), HasSubstr("is no time"));
  EXPECT_THAT(refusal_of(write(R"({"median": 1, "interval": [1], "rounds": 9})", "null")), HasSubstr("no time"));
  EXPECT_THAT(refusal_of(write(R"({"median": 1, "interval": null, "rounds": 0})", "null")), HasSubstr("is no time"));
  EXPECT_THAT(refusal_of(std::string(17 << 20, ' ')), HasSubstr("MiB"));
}

TEST_F(GpuTimesTest, WhereTheMapCouldNotBeDrawn_OnlyAStaticLightHasATime) {
  const GpuTimes times = read(write("null", kFilter));
  Results results;
  results.cells.resize(1);
  results.cells[0].key = "a";
  apply_gpu_times(results, times);
  EXPECT_FALSE(results.cells[0].time_ms.moving || results.cells[0].time_ms.map);
  EXPECT_DOUBLE_EQ(results.cells[0].time_ms.static_light->median, 2.0);
}

TEST_F(GpuTimesTest, TimesOfAnotherRunAreRefused) {
  const GpuTimes times = read(write(kFilter, "null", "elsewhere"));
  Results results;
  results.cells.resize(1);
  EXPECT_THROW(apply_gpu_times(results, times), Error);
}

/// A filter with one training and one unseen view of these scores.
TunedFilterRecord make_filter(TunedScore training, TunedScore unseen, bool in_visibility = true) {
  TunedFilterRecord filter;
  filter.id = filter.label = "vsm";
  filter.defaults = {{"radius", 4.0}, {"store", "rg32f"}};
  filter.searched = {{"radius", "texels", "linear", 0.0, 64.0, 4.0, 7.0, {{5.0, 9.0}, {20.0, 20.0}}, 0.125, false},
                     {"idle", "", "linear", 0.0, 1.0, 0.5, 0.5, {{0.0, 1.0}}, 1.0, true}};
  filter.views = {{"cubes", "as it is", true, training, 0.001}, {"cubes", "camera +10", false, unseen, 0.002}};
  filter.search_evaluations = 80;
  filter.evaluations = 107;
  judge_tuning(filter, {{"radius", 7.0}, {"store", "rg32f"}}, in_visibility);
  return filter;
}

TunedRecord make_record(const TunedFilterRecord& filter) {
  TunedRecord record;
  record.metric = "rmse";
  record.map_size = 1024;
  record.tolerance = 0.1;
  record.scenes = {"cubes"};
  record.filters = {filter};
  return record;
}

double radius_of(const TunedFilterRecord& filter) { return std::get<double>(filter.params.at("radius")); }

TEST(JudgeTuning, KeepsWhatIsBetterOnUnseenViews) {
  const TunedFilterRecord filter = make_filter({0.10, 0.05}, {0.12, 0.08});
  EXPECT_EQ(filter.verdict, TuneVerdict::kBetter);
  EXPECT_EQ(radius_of(filter), 7.0);
  EXPECT_DOUBLE_EQ(filter.unseen.gain(), 0.04);
  EXPECT_EQ(filter.unseen_truth_se, 0.002);
}

TEST(JudgeTuning, KeepsTheDefault_WhereUnseenViewsGetWorse) {
  const TunedFilterRecord filter = make_filter({0.10, 0.05}, {0.08, 0.09});
  EXPECT_EQ(filter.verdict, TuneVerdict::kOverfitted);
  EXPECT_EQ(radius_of(filter), 4.0);
  EXPECT_THAT(pages::describe_verdict(filter, "rmse"), HasSubstr("Overfitted"));
}

TEST(JudgeTuning, AGainWithinTheTruthsStandardError_IsNone) {
  const TunedFilterRecord small = make_filter({0.10, 0.05}, {0.080, 0.079});
  EXPECT_EQ(small.verdict, TuneVerdict::kNoGain);
  EXPECT_EQ(radius_of(small), 4.0);
  EXPECT_THAT(pages::describe_verdict(small, "rmse"), HasSubstr("within the truth's standard error"));
  EXPECT_EQ(make_filter({0.10, 0.10}, {0.08, 0.08}).verdict, TuneVerdict::kNoGain);
  EXPECT_EQ(make_filter({0.10, 0.05}, {0.080, 0.079}, false).verdict,
            TuneVerdict::kBetter);  // that error is of another unit
}

TEST(JudgeTuning, Means_AreOfTheViewsOfOneKind) {
  TunedFilterRecord filter = make_filter({0.10, 0.05}, {0.12, 0.08});
  filter.views.push_back({"stack", "camera +10", false, {0.06, 0.02}, 0.004});
  judge_tuning(filter, {{"radius", 7.0}}, true);
  EXPECT_DOUBLE_EQ(filter.unseen.at_default, 0.09);
  EXPECT_DOUBLE_EQ(filter.unseen.tuned, 0.05);
  EXPECT_DOUBLE_EQ(*filter.unseen_truth_se, 0.003);
  EXPECT_DOUBLE_EQ(filter.training.tuned, 0.05);
}

TEST(TunedJson, ReadsBackAsItWasWritten) {
  TunedFilterRecord filter = make_filter({0.10, 0.05}, {0.12, 0.08});
  filter.params["min_variance"] = 3.881e-08;
  filter.params["flag"] = true;
  const TestFolder folder;
  const TunedSettings settings = read_tuned_settings(folder.write("tuned.json", make_tuned_json(make_record(filter))));
  EXPECT_EQ(settings.metric, "rmse");
  EXPECT_EQ(settings.map_size, 1024);
  ASSERT_EQ(settings.filters.size(), 1u);
  EXPECT_EQ(settings.filters[0].id, "vsm");
  EXPECT_EQ(settings.filters[0].params, filter.params);
}

TEST(TunePage, SaysParametersScoresGainAndRanges_InBothFormats) {
  TunedRecord record = make_record(make_filter({0.10, 0.05}, {0.12, 0.08}));
  for (const std::string& written :
       {document::write_markdown(pages::make_tune_page(record)), document::write_html(pages::make_tune_page(record))}) {
    for (const char* part : {"+33.3 %", "rmse 0.12 to 0.08", "standard error is 0.002", "5 .. 9, and 20", "12.5 %",
                             "all of it: no effect", "107 settings", "tuned.json"})
      EXPECT_THAT(written, HasSubstr(part));
    EXPECT_THAT(written, Not(HasSubstr("Overfitted")));
  }
}

TEST(TunePage, BeginsWithTheAnswer_WhatWasFound_AndWhatItGains) {
  TunedRecord record = make_record(make_filter({0.10, 0.05}, {0.12, 0.08}));
  record.filters.push_back(make_filter({0.10, 0.05}, {0.08, 0.09}));
  record.filters.back().label = "esm";
  record.scenes = {"cubes", "ball", "stack"};
  for (TunedFilterRecord& filter : record.filters) {
    filter.views.push_back({"ball", "camera +10", false, {0.02, 0.03}, 0.004});
    filter.views.push_back({"stack", "camera +10", false, {0.02, 0.019}, 0.004});
  }
  const document::Page page = pages::make_tune_page(record);
  EXPECT_EQ(document::answer_of(page),
            "Better on unseen views: vsm with radius 7, idle 0.5: rmse 0.12 to 0.08 (+33.3 %). The default stays for "
            "esm.");
  using document::Grade;
  EXPECT_EQ(document::verdict_of(page, "cubes", "vsm"), std::pair(std::string("+33.3 %"), Grade::kGood));
  EXPECT_EQ(document::verdict_of(page, "ball", "vsm"), std::pair(std::string("\u2717 -50.0 %"), Grade::kBad));
  EXPECT_EQ(document::verdict_of(page, "stack", "vsm"), std::pair(std::string("+5.0 %"), Grade::kNear));
  EXPECT_EQ(document::verdict_of(page, "all scenes", "esm"), std::pair(std::string("\u2717 -12.5 %"), Grade::kBad));
}

}  // namespace
}  // namespace shadowbench::records
