#include "report/pages/bias_page.h"

#include <glm/glm.hpp>

#include "report/records/format.h"
#include "tests/report/pages/answer.h"
#include "tests/test_files.h"

namespace shadowbench::pages {
namespace {

using document::Grade;

const std::vector<double> kFactors = {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

/// Acne goes to nothing at `enough`, contact opens from theory on.
void add_curve(records::BiasSweepRecord& sweep, const std::string& mode, const std::string& filter, double enough,
               double gap_at_theory = 0.01, double gap_above = 0.5) {
  for (const double factor : kFactors) {
    records::BiasCell& cell = sweep.cells.emplace_back();
    cell.filter = filter;
    cell.mode = mode;
    cell.key = "depth";
    cell.bias = fmt::format("{}:depth={}", mode, 0.5 * factor);
    cell.factor = factor;
    cell.setting = 0.5 * factor;
    cell.acne = factor < enough ? 0.25 : 0.0;
    cell.contact_gap = factor > 1.0 ? gap_above : gap_at_theory;
  }
}

/// Two filters under a mode with amounts, and one under a mode without.
records::BiasSweepRecord make_sweep() {
  records::BiasSweepRecord sweep{"sun"};
  sweep.filters = {"none", "pcf2x2"};
  sweep.modes = {{"constant", "One depth."}, {"midpoint", "Half-way."}};
  add_curve(sweep, "constant", "none", 1.0);
  add_curve(sweep, "constant", "pcf2x2", 0.5);
  records::BiasCell& cell = sweep.cells.emplace_back();
  cell.filter = "none";
  cell.mode = cell.bias = "midpoint";
  cell.acne = 0.125;
  return sweep;
}

void set_all(records::BiasSweepRecord& sweep, std::optional<double> records::BiasCell::*rate,
             std::optional<double> value, const std::string& mode = "constant") {
  for (records::BiasCell& cell : sweep.cells)
    if (cell.mode == mode) cell.*rate = value;
}

document::Chart chart_of(const records::BiasSweepRecord& sweep) { return make_bias_charts(sweep).charts.at(0); }

const document::ChartSeries* find_series(const document::Chart& chart, const std::string& title) {
  const auto found = std::ranges::find(chart.series, title, &document::ChartSeries::title);
  return found == chart.series.end() ? nullptr : &*found;
}

TEST(BiasChart, AcneIsSolid_ContactGapDashed_TheoryAVerticalLine_AmountsEquallyFarApart) {
  const records::BiasSweepRecord sweep = make_sweep();
  EXPECT_EQ(make_bias_charts(sweep).charts.size(), 1u) << "none of a mode without amounts";
  const document::Chart chart = chart_of(sweep);
  ASSERT_EQ(chart.x.ticks.size(), kFactors.size());
  EXPECT_EQ(chart.x.ticks[0].second, "0");
  EXPECT_EQ(chart.x.ticks[1].second, "1/8");
  const document::ChartSeries* acne = find_series(chart, "pcf2x2: acne");
  const document::ChartSeries* gap = find_series(chart, "pcf2x2: contact gap");
  const document::ChartSeries* theory = find_series(chart, "theory");
  ASSERT_TRUE(acne && gap && theory);
  EXPECT_EQ(acne->line, document::LineStyle::kSolid);
  EXPECT_EQ(gap->line, document::LineStyle::kDashed);
  EXPECT_EQ(acne->color, gap->color);
  EXPECT_NE(acne->color, find_series(chart, "none: acne")->color);
  ASSERT_EQ(acne->points.size(), kFactors.size());
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    EXPECT_EQ(chart.x.ticks[i].first, static_cast<double>(i));
    EXPECT_EQ(acne->points[i].x.value, static_cast<double>(i));
  }
  EXPECT_EQ(acne->points[1].y.value, 25.0);
  EXPECT_EQ(gap->points.back().y.value, 50.0);
  ASSERT_EQ(theory->points.size(), 2u);
  for (const document::ChartPoint& point : theory->points) EXPECT_EQ(chart.x.ticks.at(4).first, point.x.value);
}

/// The key names what is drawn, each filter in the colour that it has on the whole page.
TEST(BiasChart, WhatIsAbsent_HasNoSeries_AndTheOthersKeepTheirColours) {
  records::BiasSweepRecord sweep = make_sweep();
  const std::string color = find_series(chart_of(sweep), "pcf2x2: acne")->color;
  std::erase_if(sweep.cells, [](const records::BiasCell& cell) { return cell.filter == "none"; });
  set_all(sweep, &records::BiasCell::contact_gap, {});
  const document::Chart chart = chart_of(sweep);
  EXPECT_FALSE(find_series(chart, "none: acne"));
  EXPECT_FALSE(find_series(chart, "pcf2x2: contact gap"));
  EXPECT_EQ(find_series(chart, "pcf2x2: acne")->color, color);
}

TEST(BiasChart, AtMostSixCurves_AreShown_OfNoneAndTheFiltersThatNeedMost) {
  records::BiasSweepRecord sweep = make_sweep();
  for (const auto& [name, enough] : {std::pair("a", 2.0), std::pair("b", 4.0), std::pair("c", 100.0)}) {
    sweep.filters.emplace_back(name);
    add_curve(sweep, "constant", name, enough);
  }
  EXPECT_THAT(document::list_shown(chart_of(sweep)),
              ElementsAre("none: acne", "none: contact gap", "b: acne", "b: contact gap", "c: acne", "c: contact gap",
                          "theory"));
}

TEST(BiasPage, BeginsWithTheAnswer_AndJudgesEachMode) {
  records::BiasSweepRecord sweep = make_sweep();
  const std::string of_two = "2 of 2 filters have less than 0.1 % acne with the bias to ship";
  EXPECT_EQ(document::answer_of(make_bias_page("", {sweep})), of_two + "; the widest contact gap is 1 %, of none.");
  for (const char* filter : {"vsm", "esm", "wide"}) sweep.filters.emplace_back(filter);
  add_curve(sweep, "constant", "vsm", 0.0, 0.0);
  add_curve(sweep, "constant", "esm", 100.0);
  add_curve(sweep, "constant", "wide", 2.0);
  const document::Page page = make_bias_page("", {sweep});
  const auto verdict = [&](const char* filter) { return document::verdict_of(page, "constant", filter); };
  EXPECT_EQ(verdict("none"), std::pair(std::string("1, gap 1 %"), Grade::kNear));
  EXPECT_EQ(verdict("pcf2x2"), std::pair(std::string("1/2, gap 1 %"), Grade::kNear));
  EXPECT_EQ(verdict("vsm"), std::pair(std::string("0, gap 0 %"), Grade::kGood));
  EXPECT_EQ(verdict("esm"), std::pair(std::string("\u2717 acne 25 %"), Grade::kBad));
  EXPECT_EQ(verdict("wide"), std::pair(std::string("\u2717 2, gap 50 %"), Grade::kBad));
  EXPECT_EQ(document::verdict_of(page, "midpoint", "none").first, "\u2717 acne 12.5 %");
  EXPECT_EQ(document::verdict_of(page, "to ship", "pcf2x2").first, "constant:depth=0.25, contact gap 1 %");
  EXPECT_EQ(document::verdict_of(page, "to ship", "esm").second, Grade::kBad);
  sweep = make_sweep();
  set_all(sweep, &records::BiasCell::contact_gap, {});
  EXPECT_THAT(document::answer_of(make_bias_page("", {sweep})), StartsWith(of_two + "; contact gaps are absent"));
}

TEST(BiasPage, OfSeveralLights_HasAPartForEach_UnderItsName) {
  records::BiasSweepRecord lamp = make_sweep();
  lamp.light = "lamp";
  const document::Page page = make_bias_page("", {make_sweep(), lamp, {"moon", "no receiver is lit"}});
  ASSERT_EQ(page.sections.size(), 3u + 1u);
  std::set<std::string> ids;
  for (const document::Section& section : page.sections) ids.insert(section.id);
  EXPECT_EQ(ids.size(), page.sections.size());
  EXPECT_EQ(page.sections[1].heading, "lamp");
  EXPECT_THAT(document::write_markdown(page), HasSubstr("## moon\n\nno receiver is lit"));
}

TEST(BiasPage, TheBiasToShip_OpensTheNarrowestGap_OfThoseThatAreEnough) {
  records::BiasSweepRecord sweep = make_sweep();
  const auto find = [&](const std::string& filter) {
    for (const records::BiasCell& each : recommend_biases({sweep, {"lamp", "no receiver is lit"}}))
      if (each.filter == filter) return describe_bias(each);
    return std::string("none");
  };
  set_all(sweep, &records::BiasCell::acne, 0.0, "midpoint");  // frees `none`, and nobody knows its gap
  sweep.modes.push_back({"plane", ""});
  add_curve(sweep, "plane", "none", 0.25, 0.005, 0.005);
  EXPECT_EQ(find("none"), "plane:depth=0.125, contact gap 0.5 %");
  EXPECT_EQ(find("pcf2x2"), "constant:depth=0.25, contact gap 1 %");
  set_all(sweep, &records::BiasCell::acne, 0.5, "plane");
  EXPECT_EQ(find("none"), "constant:depth=0.5, contact gap 1 %");
  set_all(sweep, &records::BiasCell::contact_gap, 1.0);
  EXPECT_EQ(find("none"), "midpoint, contact gap \u2013") << "better than one that is surely wide";
  set_all(sweep, &records::BiasCell::acne, 0.5);
  set_all(sweep, &records::BiasCell::acne, 0.5, "midpoint");
  EXPECT_EQ(find("none"), "no mode removes its acne");
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

/// The least amount of a mode that is enough is `setting`.
void add_mode(records::BiasSweepRecord& sweep, const std::string& mode, double setting) {
  sweep.modes.push_back({mode, ""});
  for (const double factor : {0.0, 1.0, 2.0}) {
    records::BiasCell& cell = sweep.cells.emplace_back();
    cell.filter = "none";
    cell.mode = mode;
    cell.factor = factor;
    cell.setting = factor * setting;
    cell.lift_m = factor * kLift;
    cell.lift_depth = *cell.lift_m / kRange;
    cell.lift_texels = *cell.lift_m / kTexel;
    cell.acne = factor > 0.0 ? 0.0 : 0.5;
  }
}

records::BiasSweepRecord make_engine_sweep() {
  records::BiasSweepRecord sweep{"sun"};
  sweep.filters = {"none", "vsm"};
  sweep.angle_deg = kAngle;
  sweep.texel_m = {kTexel, kTexel};
  add_mode(sweep, "constant", kLift / kRange);
  add_mode(sweep, "normal-offset", kLift / (kTexel * std::tan(kAngle * std::numbers::pi / 180.0)));
  add_mode(sweep, "polygon-offset", 1.75);
  return sweep;
}

TEST(EngineBias, Settings_MoveAsFarAsTheBiasTheyStandFor) {
  const document::Details details = make_engine_details(make_engine_sweep());
  const records::TextTable& table = document::find_block<document::Table>(details.blocks)->table;
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
  sweep.texel_m.high *= 2.0;
  EXPECT_FALSE(document::find_block<document::Table>(make_engine_details(sweep).blocks));
}

}  // namespace
}  // namespace shadowbench::pages
