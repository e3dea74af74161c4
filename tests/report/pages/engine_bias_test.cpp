// The settings of engines move a receiver, or a caster, as far above the receiver's plane as the bias that they stand
// for.

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <numbers>

#include "report/pages/bias_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

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
