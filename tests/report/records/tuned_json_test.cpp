#include <gmock/gmock.h>

#include <filesystem>

#include "base/files.h"
#include "report/pages/tune_page.h"
#include "report/records/tuned_record.h"
#include "tests/report/pages/answer.h"

namespace shadowbench::records {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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
  const auto file = std::filesystem::temp_directory_path() / "shadowbench.tuned_json_test.json";
  write_text_file(file, make_tuned_json(make_record(filter)));
  const TunedSettings settings = read_tuned_settings(file);
  std::filesystem::remove(file);
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
