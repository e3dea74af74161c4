#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.h"
#include "harness/stress/axis.h"
#include "harness/stress/synthetic_scene.h"
#include "report/records/text_table.h"

namespace shadowbench::stress {
namespace depth_formats {

constexpr double kBound = 0.01;  // of a distance
constexpr double kBroken = 0.5;
constexpr const char* kSource =
    "derived from OpenGL 4.5 core specification, sections 2.3.5 (fixed point) and 13.6 (depth): d^2 (f - n) / (n f) "
    "times half a quantum, over d";

struct Setting {
  GLenum format;
  bool perspective;
  bool reversed;
};

std::string name(const Setting& setting) {
  const char* format = setting.format == GL_DEPTH_COMPONENT16   ? "D16"
                       : setting.format == GL_DEPTH_COMPONENT24 ? "D24"
                                                                : "D32F";
  return fmt::format("{}, {}{}", format, setting.perspective ? "perspective" : "orthographic",
                     setting.reversed ? ", reversed" : "");
}

/// Gives half a quantum of the depth that is stored where the relative error, (f/n - 1) times that, is largest: at the
/// near plane of an orthographic light, where a distance is smallest; at the far plane of a perspective one, where a
/// step is largest.
double find_quantum(const Setting& setting) {
  const bool stores_one = setting.perspective != setting.reversed;
  return largest_rounding(setting.format, stores_one ? 1.0 : 0.0);
}

Theory make_theory(const Setting& setting, double error, Verdict predicts) {
  const double rounding = find_quantum(setting);
  const char* where = setting.perspective ? "far" : "near";
  if (rounding < 0x1p-40) {
    return {std::nullopt, TheoryKind::kQuantum,
            fmt::format("none: a float is finest where it is stored near 0, here at the {} plane", where), kSource,
            predicts};
  }
  // In perspective the true distance is the smaller one, n f / (n + (f - n) q / 2) that reads back as f; else the
  // larger one, n + (f - n) q / 2.
  const double steps = setting.perspective ? error : error / (1.0 - error);
  return {1.0 + steps / rounding, TheoryKind::kQuantum,
          fmt::format("1 + {:.4g} / {:.3g}, half a quantum at the {} plane", steps, rounding, where), kSource,
          predicts};
}

Observation judge_error(const DepthError& seen) {
  const auto why = [&](double bound) {
    return fmt::format("off by {:.3g} of the distance at {:.4g} near-plane distances, over {:g}", seen.relative,
                       seen.distance, bound);
  };
  if (!std::isfinite(seen.relative))
    return {Verdict::kBroken, std::nullopt, "a distance reads back as NaN or infinite"};
  return judge_by_bounds(seen.relative, kBound, kBroken, why);
}

Case make_case(const AxisInputs& inputs, const Setting& setting) {
  if (!inputs.renderer) return {.variant = name(setting), .not_available = "there is no GL"};
  Case item{.variant = name(setting)};
  item.theories = {make_theory(setting, kBound, Verdict::kDegraded), make_theory(setting, kBroken, Verdict::kBroken)};
  const auto depths = std::make_shared<StoredDepths>(inputs.renderer->shaders, setting.format);
  item.observe = [setting, depths](double ratio) {
    return judge_error(depths->find_largest_error({ratio, setting.perspective, setting.reversed}));
  };
  return item;
}

std::vector<Setting> list_settings() {
  std::vector<Setting> settings;
  for (const bool perspective : {false, true}) {
    for (const GLenum format : {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F})
      for (const bool reversed : {false, true}) settings.push_back({format, perspective, reversed});
  }
  return settings;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  std::vector<Case> cases;
  for (const Setting& setting : list_settings()) cases.push_back(make_case(inputs, setting));
  return cases;
}

constexpr double kShownRatio = 1000.0;

/// Tabulates the error at a few distances, over the error that theory has there.
records::TextTable make_growth_table(render::ShaderLibrary& shaders) {
  records::TextTable table{{"case"}, {}};
  for (const double distance : {2.0, 10.0, 100.0, 900.0}) table.header.push_back(fmt::format("at {:g} n", distance));
  for (const Setting& setting : list_settings()) {
    std::vector<std::string> row = {name(setting)};
    try {
      StoredDepths depths(shaders, setting.format);
      const DepthPlan plan{kShownRatio, setting.perspective, setting.reversed};
      for (const double distance : {2.0, 10.0, 100.0, 900.0}) {
        const double error = depths.find_error_around(plan, distance),
                     theory = find_distance_error(setting.format, plan, distance);
        row.push_back(fmt::format("{:.3g} n = {:.2f} x theory", error, error / theory));
      }
    } catch (const Error& error) {
      row.resize(table.header.size(), fmt::format("not available: {}", error.what()));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<Exhibit> make_exhibits(const AxisInputs& inputs) {
  Exhibit exhibit;
  exhibit.id = "growth";
  exhibit.title = "What a stored distance is off by, at most, against theory";
  exhibit.sentences = {fmt::format(
      "Far plane at {:g} n, n the near plane's distance. Theory: half a quantum where depth is linear; d^2 (f - n) / "
      "(n f) times that in perspective, "
      "which grows with the square of the distance d, and is more where a step is no longer small against d. "
      "The GL is handed 32-bit floats, whose own rounding adds up to as much again in D24.",
      kShownRatio)};
  exhibit.table = make_growth_table(inputs.renderer->shaders);
  return {exhibit};
}

}  // namespace depth_formats

Axis make_depth_formats_axis() {
  using namespace depth_formats;
  Axis axis;
  axis.title = "Depth formats: what is left of a distance";
  axis.quantity = "far plane's distance / near plane's";
  axis.range = {10.0, 1e7};
  axis.limits = {1.5, 1e9};
  axis.coarse_samples = 25;
  axis.measured = "largest relative error of a distance, stored and read back";
  axis.bound = kBound;
  axis.broken_when = fmt::format("a distance reads back more than {:g} of itself off, or not finite", kBroken);
  axis.make_cases = make_cases;
  axis.make_exhibits = make_exhibits;
  return axis;
}

}  // namespace shadowbench::stress
