#include "report/pages/bias_page.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <numbers>
#include <set>

#include "report/records/format.h"
#include "tests/report/pages/answer.h"

namespace shadowbench::pages {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<double> kFactors = {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

/// Acne goes to nothing at `enough`, contact opens from theory on.
records::BiasCurve make_curve(const std::string& filter, double enough) {
  records::BiasCurve curve{filter, 0.5, 0.01, 2.0, 0.4, {}};
  for (const double factor : kFactors)
    curve.points.push_back({factor, factor * 0.5, factor < enough ? 0.25 : 0.0, factor > 1.0 ? 0.5 : 0.01});
  return curve;
}

records::BiasSweepRecord make_sweep() {
  records::BiasSweepRecord sweep;
  sweep.scene = "steps";
  sweep.filters = {"none", "pcf2x2"};
  sweep.acne_receivers = 5000;
  sweep.contact_receivers = 300;
  sweep.fewest_receivers = 100;
  sweep.modes.push_back({"constant",
                         "depth",
                         "One depth.",
                         {make_curve("none", 1.0), make_curve("pcf2x2", 0.5)},
                         {},
                         "bias.constant.png",
                         "pictures"});
  records::BiasModeRecord fixed{"midpoint", "", "Half-way.", {}, {}, {}, {}};
  fixed.curves.push_back({"none", 0, 0, 0, 0, {{std::nullopt, 0.0, 0.125, std::nullopt}}});
  sweep.modes.push_back(fixed);
  return sweep;
}

void make_gap_absent(records::BiasSweepRecord& sweep) {
  for (records::BiasCurve& curve : sweep.modes[0].curves)
    for (records::BiasPoint& point : curve.points) point.contact_gap.reset();
}

const document::ChartSeries* find_series(const document::Chart& chart, const std::string& title) {
  const auto found = std::ranges::find(chart.series, title, &document::ChartSeries::title);
  return found == chart.series.end() ? nullptr : &*found;
}

TEST(BiasChart, Factors_AreEquallyFarApart_NoBiasIncluded) {
  const records::BiasSweepRecord sweep = make_sweep();
  const document::Chart chart = make_bias_charts(sweep).charts[0];
  ASSERT_TRUE(chart.x.log);
  ASSERT_EQ(chart.x.ticks.size(), kFactors.size());
  EXPECT_EQ(chart.x.ticks[0].second, "0");
  EXPECT_EQ(chart.x.ticks[1].second, "1/8");
  for (std::size_t i = 1; i < kFactors.size(); ++i)
    EXPECT_DOUBLE_EQ(chart.x.ticks[i].first / chart.x.ticks[i - 1].first, 2.0);
}

TEST(BiasChart, AcneIsSolid_ContactGapDashed_TheoryAVerticalLine) {
  const records::BiasSweepRecord sweep = make_sweep();
  const document::Chart chart = make_bias_charts(sweep).charts[0];
  const document::ChartSeries* acne = find_series(chart, "pcf2x2: acne");
  const document::ChartSeries* gap = find_series(chart, "pcf2x2: contact gap");
  const document::ChartSeries* theory = find_series(chart, "theory");
  ASSERT_TRUE(acne && gap && theory);
  EXPECT_EQ(acne->line, document::LineStyle::kSolid);
  EXPECT_EQ(gap->line, document::LineStyle::kDashed);
  EXPECT_EQ(acne->color, gap->color);
  EXPECT_NE(acne->color, find_series(chart, "none: acne")->color);
  ASSERT_EQ(acne->points.size(), kFactors.size());
  EXPECT_EQ(acne->points[1].x.value, 0.125);
  EXPECT_EQ(acne->points[1].y.value, 0.25);
  EXPECT_EQ(gap->points.back().y.value, 0.5);
  ASSERT_EQ(theory->points.size(), 2u);
  for (const document::ChartPoint& point : theory->points) EXPECT_EQ(point.x.value, 1.0);
}

TEST(BiasChart, AbsentRates_HaveNoLine_AndAreSaid) {
  records::BiasSweepRecord sweep = make_sweep();
  EXPECT_THAT(make_bias_charts(sweep).charts[0].notes, ElementsAre());
  make_gap_absent(sweep);
  const document::Chart chart = make_bias_charts(sweep).charts[0];
  EXPECT_THAT(chart.notes, ElementsAre("contact gap: absent"));
  EXPECT_FALSE(find_series(chart, "none: contact gap"));
  EXPECT_TRUE(find_series(chart, "none: acne"));
}

/// The key names the filters that are drawn, each in the colour that it has on the whole page.
TEST(BiasChart, FiltersThatAreLeftOut_HaveNoSeries_AndTheOthersKeepTheirColours) {
  records::BiasSweepRecord sweep = make_sweep();
  const std::string color = find_series(make_bias_charts(sweep).charts[0], "pcf2x2: acne")->color;
  sweep.modes[0].curves.erase(sweep.modes[0].curves.begin());
  const document::Chart chart = make_bias_charts(sweep).charts[0];
  EXPECT_FALSE(find_series(chart, "none: acne"));
  EXPECT_EQ(find_series(chart, "pcf2x2: acne")->color, color);
}

TEST(BiasPage, BeginsWithTheAnswer_AndJudgesEachModeBelow) {
  records::BiasSweepRecord sweep = make_sweep();
  sweep.modes[0].curves.push_back(make_curve("vsm", 0.0));
  sweep.modes[0].curves.push_back(make_curve("esm", 100.0));
  sweep.modes[0].curves.push_back(make_curve("wide", 2.0));
  for (records::BiasPoint& point : sweep.modes[0].curves[2].points) point.contact_gap = 0.0;
  const document::Page page = make_bias_page({sweep});
  EXPECT_EQ(document::answer_of(page),
            "With the bias below 2 of 2 filters have less than 0.1 % acne; the widest contact gap is 1 %, of none.");
  const auto verdict = [&](const char* filter) { return document::verdict_of(page, "constant", filter, "modes"); };
  using document::Grade;
  EXPECT_EQ(verdict("none"), std::pair(std::string("1, gap 1 %"), Grade::kNear));
  EXPECT_EQ(verdict("pcf2x2"), std::pair(std::string("1/2, gap 1 %"), Grade::kNear));
  EXPECT_EQ(verdict("vsm"), std::pair(std::string("0, gap 0 %"), Grade::kGood));
  EXPECT_EQ(verdict("esm"), std::pair(std::string("\u2717 acne 25 %"), Grade::kBad));
  EXPECT_EQ(verdict("wide"), std::pair(std::string("\u2717 2, gap 50 %"), Grade::kBad));
  EXPECT_EQ(document::verdict_of(page, "midpoint", "none", "modes").first, "\u2717 acne 12.5 %");
}

TEST(BiasChart, AtMostSixCurves_AreShown_OfNoneAndTheFiltersThatNeedMost) {
  records::BiasSweepRecord sweep = make_sweep();
  for (const auto& [name, enough] : {std::pair("a", 2.0), std::pair("b", 4.0), std::pair("c", 100.0)})
    sweep.modes[0].curves.push_back(make_curve(name, enough));
  EXPECT_THAT(document::list_shown(make_bias_charts(sweep).charts[0]),
              ElementsAre("none: acne", "b: acne", "c: acne", "none: contact gap", "b: contact gap", "c: contact gap",
                          "theory"));
}

TEST(BiasPage, AbsentRates_AreSaid_NeverNumbers) {
  records::BiasSweepRecord sweep = make_sweep();
  make_gap_absent(sweep);
  sweep.contact_receivers = 7;
  EXPECT_EQ(document::answer_of(make_bias_page({sweep})),
            "With the bias below 2 of 2 filters have less than 0.1 % acne; contact gaps are absent: fewer than 100 "
            "receivers are left to rate.");
}

/// Of a sun that needs little bias, and a lamp under which nothing could be swept.
std::vector<records::BiasSweepRecord> make_two_lights() {
  records::BiasSweepRecord sun = make_sweep(), lamp;
  sun.scene = "city.sun";
  sun.light = "sun";
  lamp.scene = "city.lamp";
  lamp.light = "lamp";
  lamp.refused = "no receiver is lit";
  sun.map_size = lamp.map_size = 512;
  sun.width = lamp.width = 320;
  sun.height = lamp.height = 180;
  return {sun, lamp};
}

TEST(BiasPage, OfSeveralLights_NamesThem_AndHasAPartForEach) {
  std::vector<records::BiasSweepRecord> sweeps = make_two_lights();
  const document::Page page = make_bias_page(sweeps);
  EXPECT_EQ(page.title, "Depth bias on city under sun, lamp, map 512, 320 x 180");
  EXPECT_THAT(document::answer_of(page), ::testing::StartsWith("sun: With the bias below "));
  EXPECT_THAT(document::write_markdown(page), HasSubstr("lamp: no receiver is lit"));
  sweeps[1] = sweeps[0];
  sweeps[1].light = "lamp";
  std::set<std::string> ids;
  for (const document::Section& section : make_bias_page(sweeps).sections) ids.insert(section.id);
  EXPECT_EQ(ids.size(), 2u + 2u * 2u) << "an answer, the data, and for each light its engines and its modes";
}

TEST(BiasPage, TheBiasToShip_OpensTheNarrowestGap_OfThoseThatAreEnough) {
  std::vector<records::BiasSweepRecord> sweeps = make_two_lights();
  sweeps[0].modes[1].curves[0].points[0].acne = 0.0;  // midpoint frees `none`, and nobody knows its gap
  records::BiasModeRecord plane = sweeps[0].modes[0];
  plane.mode = "plane";
  plane.key = "texels";
  plane.curves = {make_curve("none", 0.25)};
  for (records::BiasPoint& point : plane.curves[0].points) point.contact_gap = 0.005;
  sweeps[0].modes.push_back(plane);
  const auto find = [&](const std::string& filter) {
    for (const records::BiasToShip& ship : list_bias_to_ship(sweeps))
      if (ship.filter == filter) return describe_bias_to_ship(ship);
    return std::string("none");
  };
  EXPECT_EQ(find("none"), "plane:texels=0.125, contact gap 0.5 %");
  EXPECT_EQ(find("pcf2x2"), "constant:depth=0.25, contact gap 1 %");
  for (records::BiasPoint& point : sweeps[0].modes[2].curves[0].points) point.acne = 0.5;
  EXPECT_EQ(find("none"), "constant:depth=0.5, contact gap 1 %");
  // A gap that nobody knows is better than one that is surely wide.
  for (records::BiasPoint& point : sweeps[0].modes[0].curves[0].points) point.contact_gap = 1.0;
  EXPECT_EQ(find("none"), "midpoint, contact gap \u2013");
  sweeps[0].modes.resize(1);
  for (records::BiasPoint& point : sweeps[0].modes[0].curves[0].points) point.acne = 0.5;
  EXPECT_EQ(find("none"), "no mode removes its acne");
  EXPECT_EQ(list_bias_to_ship(sweeps).size(), 2u) << "none of the lamp";
}

TEST(BiasPage, Csv_HasARowPerAmount_AbsentIsEmpty) {
  records::BiasSweepRecord sweep = make_sweep();
  sweep.modes[0].curves[1].filter = "poisson (taps 8, radius 2)";
  const std::string csv = make_bias_csv({sweep});
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 16 + 1);
  EXPECT_THAT(csv, HasSubstr("steps,,0,constant,depth,none,0.5,0.25,0.005,1,0.2,0.25,0.01\r\n"));
  EXPECT_THAT(csv, HasSubstr("\"poisson (taps 8, radius 2)\""));
  EXPECT_THAT(csv, HasSubstr("steps,,0,midpoint,,none,,,,,,0.125,\r\n"));
}

// The settings of engines move a receiver, or a caster, as far above the receiver's plane as the bias that they stand
// for.

constexpr double kAngle = 60.0, kTexel = 0.05, kRange = 20.0, kLift = 0.3;  // degrees, metres

/// A plane under a sun that stands overhead: its normal leans by kAngle.
const glm::dvec3 kToLight(0.0, 1.0, 0.0);
const glm::dvec3 kNormal(std::sin(kAngle* std::numbers::pi / 180.0), std::cos(kAngle* std::numbers::pi / 180.0), 0.0);

/// How far a point that was moved by `way` lies above the plane, along the light.
double lift(const glm::dvec3& way) { return glm::dot(way, kNormal) / glm::dot(kToLight, kNormal); }

/// What engines do with their settings; casters are moved the other way.
const std::map<std::string, std::function<glm::dvec3(double)>> kEngines = {
    {"three.js bias", [](double bias) { return kToLight * (-bias * kRange); }},
    {"three.js normalBias", [](double bias) { return kNormal * bias; }},
    {"Unity URP Depth Bias", [](double bias) { return kToLight * (2.5 * kTexel * bias); }},
    {"Unity URP Normal Bias",
     [](double bias) { return kNormal * (2.5 * kTexel * bias * (1.0 - glm::dot(kToLight, kNormal))); }},
    {"Godot Bias", [](double bias) { return kToLight * (bias / 100.0 * kRange * 2.0); }},
    {"Godot Normal Bias",
     [](double bias) {
       const glm::dvec3 way = kNormal * ((1.0 - glm::dot(kToLight, kNormal)) * bias * kTexel);
       return way - kToLight * glm::dot(kToLight, way);
     }},
    {"Filament constantBias", [](double bias) { return kToLight * bias; }},
    {"Filament normalBias", [](double bias) {
       const double n_dot_l = glm::dot(kToLight, kNormal);
       return kNormal * (std::sqrt(1.0 - n_dot_l * n_dot_l) * 0.5 * bias * kTexel);
     }}};

records::BiasModeRecord make_mode(const std::string& mode, double setting) {
  records::BiasCurve curve{"none", 2.0 * setting, 2.0 * kLift / kRange, 2.0 * kLift / kTexel, 2.0 * kLift, {}};
  curve.points = {{0.0, 0.0, 0.5, {}}, {0.5, setting, 0.0, {}}, {1.0, 2.0 * setting, 0.0, {}}};
  return {mode, "key", "", {curve}, {}, "", ""};
}

records::BiasSweepRecord make_engine_sweep() {
  records::BiasSweepRecord sweep;
  sweep.filters = {"none", "vsm"};
  sweep.angle_deg = kAngle;
  sweep.texel_m = {kTexel, kTexel};
  sweep.depth_range_m = kRange;
  const double tangent = std::tan(kAngle * std::numbers::pi / 180.0);
  sweep.modes = {make_mode("constant", kLift / kRange), make_mode("normal-offset", kLift / (kTexel * tangent)),
                 make_mode("polygon-offset", 1.75)};
  return sweep;
}

const records::TextTable& table_of(const document::Section& section) {
  for (const document::Block& block : section.blocks)
    if (const auto* table = std::get_if<document::Table>(&block)) return table->table;
  throw std::logic_error("no table");
}

TEST(EngineBias, Settings_MoveAsFarAsTheBiasTheyStandFor) {
  const document::Section section = make_engine_section(make_engine_sweep());
  const records::TextTable& table = table_of(section);
  ASSERT_EQ(table.rows.size(), 2u);
  std::size_t checked = 0;
  for (std::size_t i = 1; i < table.header.size(); ++i) {
    SCOPED_TRACE(table.header[i]);
    EXPECT_EQ(table.rows[1][i], records::kNothing) << "no filter without a curve has a setting";
    const double setting = std::stod(table.rows[0][i]);
    const auto engine = kEngines.find(table.header[i]);
    if (engine == kEngines.end()) {
      EXPECT_EQ(table.header[i], "glPolygonOffset factor");
      EXPECT_EQ(setting, 1.75);
      continue;
    }
    ++checked;
    EXPECT_NEAR(lift(engine->second(setting)), kLift, 0.005 * kLift);
  }
  EXPECT_EQ(checked, kEngines.size());
}

TEST(EngineBias, OfALamp_IsLeftOut) {
  records::BiasSweepRecord sweep = make_engine_sweep();
  sweep.texel_m.most *= 2.0;
  const document::Section section = make_engine_section(sweep);
  ASSERT_EQ(section.blocks.size(), 1u);
  EXPECT_THAT(std::get<document::Paragraph>(section.blocks.front()).text, ::testing::HasSubstr("under a lamp"));
}

}  // namespace
}  // namespace shadowbench::pages
