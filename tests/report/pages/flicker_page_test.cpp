// The sentences, tables and files that `shadowbench flicker` writes, from numbers made up here.

#include "report/pages/flicker_page.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "report/images/heat_figures.h"
#include "report/records/flicker_record.h"
#include "tests/report/pages/answer.h"

namespace shadowbench::pages {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kTruth = 0.01;

records::FlickerFilter make_filter(const std::string& name, double flicker) {
  return {name, flicker, flicker, 0.02, 0, {0.001, 0.002}};
}

/// Two filters over a truth that moves: "a" flickers at `a` without snapping.
records::FlickerMotion make_motion(double a, double a_snapped, double b = 0.01, double b_snapped = 0.01) {
  records::FlickerMotion motion;
  motion.id = "light";
  motion.title = "The light turns";
  motion.receivers = 1000000;
  motion.truth = {true, kTruth, 0.001, 0.0003, {0.001, 0.001}};
  motion.variants = {{false, 0.02, 0.125, 2, {make_filter("a", a), make_filter("b", b)}},
                     {true, 0.02, 0.0, 0, {make_filter("a", a_snapped), make_filter("b", b_snapped)}}};
  motion.picture = "flicker.light.png";
  return motion;
}

records::FlickerRecord make_record(const records::FlickerMotion& motion) {
  records::FlickerRecord record;
  record.scene = "cubes";
  record.frames = 3;
  record.motions = {motion};
  return record;
}

TEST(FlickerPage, BeginsWithWhoFlickersMostAndLeast_AgainstTheTruth_AndWhatSnappingBuys) {
  const document::Page page = make_flicker_page(make_record(make_motion(0.03, 0.02, 0.004, 0.004)));
  EXPECT_EQ(document::answer_of(page),
            "The light turns: most flickers a, 3.00 x (2.00 x with snapping); least b, 0.40 x.");
  EXPECT_EQ(document::verdict_of(page, "light", "a"), std::pair(std::string("\u2717 3.00 x"), document::Grade::kBad));
  EXPECT_EQ(document::verdict_of(page, "light, snapped", "a"),
            std::pair(std::string("\u2717 2.00 x"), document::Grade::kBad));
  EXPECT_EQ(document::verdict_of(page, "light", "b"), std::pair(std::string("0.40 x"), document::Grade::kGood));
  EXPECT_THAT(summarize_flicker(make_motion(0.005, 0.005)), HasSubstr("most flickers b, 1.00 x; least a, 0.50 x."));
}

TEST(FlickerPage, WhereTheTruthStandsStill_TheVerdictIsFlickerItself) {
  records::FlickerMotion motion = make_motion(0.03, 0.0, 0.003, 0.001);
  motion.truth = {};
  motion.truth.step_change = {0.0, 0.0};
  const document::Page page = make_flicker_page(make_record(motion));
  EXPECT_EQ(document::verdict_of(page, "light", "a"), std::pair(std::string("\u2717 0.03"), document::Grade::kBad));
  EXPECT_EQ(document::verdict_of(page, "light", "b"), std::pair(std::string("0.003"), document::Grade::kNear));
  EXPECT_EQ(document::verdict_of(page, "light, snapped", "a"),
            std::pair(std::string("rounding"), document::Grade::kGood));
}

TEST(FlickerPage, SaysWhatSnappingBuys) {
  const auto gain = [](const records::FlickerMotion& motion) { return make_flicker_table(motion).rows[0].back(); };
  EXPECT_EQ(gain(make_motion(0.03, 0.02)), "1.50");
  EXPECT_EQ(gain(make_motion(0.03, 0.0)), "all gone");
  EXPECT_EQ(gain(make_motion(0.02, 0.03)), "0.67");
  EXPECT_EQ(gain(make_motion(0.0, 0.0)), "–");
}

TEST(FlickerPage, StillTruth_IsNoYardstick) {
  records::FlickerMotion motion = make_motion(0.03, 0.02);
  motion.truth = {};
  motion.truth.step_change = {0.0, 0.0};
  EXPECT_THAT(summarize_flicker(motion), Not(HasSubstr(" x")));
  EXPECT_THAT(explain_motion(motion, 3), Contains(HasSubstr("all change is flicker")));
}

TEST(FlickerPage, WhatIsNotFinite_IsSaid) {
  records::FlickerMotion motion = make_motion(0.03, 0.02);
  for (const std::string& sentence : explain_motion(motion, 3)) EXPECT_THAT(sentence, Not(HasSubstr("not finite")));
  motion.variants[1].filters[0].not_finite = 7;
  EXPECT_THAT(explain_motion(motion, 3),
              Contains("With snapping, 7 changes of a are left out, because visibility is not finite."));
}

TEST(FlickerFiles, HoldEveryNumber) {
  const records::FlickerRecord record = make_record(make_motion(0.03, 0.02));
  const nlohmann::json json = nlohmann::json::parse(records::make_flicker_json(record));
  EXPECT_EQ(json["motions"][0]["variants"][1]["filters"][0]["flicker"], 0.02);
  EXPECT_EQ(json["motions"][0]["truth"]["change"], kTruth);
  const std::string csv = records::make_flicker_csv(record);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5) << "a header, two filters, without snapping and with it";
  EXPECT_THAT(csv, HasSubstr(",on,a,1000000,0.02,0.01,0.0003,0.02,0.02,0.001,0\r\n"));
  EXPECT_EQ(make_flicker_table(record.motions[0]).rows.size(), 3u) << "the filters, and the truth";
  const document::Page page = make_flicker_page(record);
  for (const std::string& written : {document::write_html(page), document::write_markdown(page)})
    for (const char* part : {"cubes", "The light turns", "flicker.light.png", "flicker.csv", "most flickers a, 3.00 x"})
      EXPECT_THAT(written, HasSubstr(part));
  EXPECT_THAT(document::write_html(page), HasSubstr("id=\"flicker.light.snapped\""));
}

TEST(FlickerCharts, OfOneMotion_ShareTheirScales_AndHoldTheTruth) {
  records::FlickerMotion motion = make_motion(0.03, 0.02);
  motion.variants[0].filters[0].step_change = {0.5, 0.1};
  const document::Chart free = make_flicker_chart(motion, motion.variants[0]),
                        snapped = make_flicker_chart(motion, motion.variants[1]);
  EXPECT_NE(free.id, snapped.id);
  EXPECT_EQ(free.y.high, snapped.y.high);
  EXPECT_GE(free.y.high, 0.5);
  EXPECT_EQ(free.series.back().title, "truth");
  ASSERT_EQ(free.series.size(), 5u) << "marks and their line for each filter, and the truth";
  EXPECT_EQ(free.series[0].title, "a");
  EXPECT_EQ(free.series[1].points.size(), 2u);
  EXPECT_EQ(free.series[1].points[0].y.value, 0.5);
  EXPECT_EQ(free.series[0].color, free.series[1].color);
  EXPECT_NE(free.series[0].mark, free.series[2].mark);
}

TEST(FlickerCharts, AtMostSixCurves_AreShown_TheTruthNoneAndTheWorst) {
  records::FlickerMotion motion = make_motion(0.03, 0.02);
  motion.variants[0].filters = {make_filter("none", 0.001)};
  for (int i = 1; i < 9; ++i) motion.variants[0].filters.push_back(make_filter(fmt::format("f{}", i), 0.01 * i));
  const document::Chart chart = make_flicker_chart(motion, motion.variants[0]);
  EXPECT_THAT(document::list_shown(chart), ElementsAre("none", "f5", "f6", "f7", "f8", "truth"));
}

TEST(FlickerPicture, ScaleIsLogarithmic_FromAThousandthOn) {
  EXPECT_DOUBLE_EQ(images::place_flicker(0.001).value(), 0.0);
  EXPECT_NEAR(images::place_flicker(0.1).value(), 2.0 / 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(images::place_flicker(1.0).value(), 1.0);
  EXPECT_DOUBLE_EQ(images::place_flicker(2.0).value(), 1.0) << "the largest change less the truth's";
  EXPECT_FALSE(images::place_flicker(0.0009));
  EXPECT_FALSE(images::place_flicker(0.0));
}

}  // namespace
}  // namespace shadowbench::pages
