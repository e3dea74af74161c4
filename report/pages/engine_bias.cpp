#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/pages/bias_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

/// The least amount of a mode without acne.
struct Need {
  double setting = 0.0;  ///< of the mode's key
  double depth = 0.0;    ///< how far that moves the steepest receiver towards the light, in [0,1] over the range
  double texels = 0.0;   ///< the same, in widths of a texel
  double metres = 0.0;   ///< the same
  double texel_m = 0.0;
  double sine = 0.0;  ///< of the angle between that receiver's normal and the light
  double cosine = 1.0;
};

/// A setting of an engine, and what becomes of a need.
struct EngineSetting {
  const char* name;
  const char* mode;
  double (*convert)(const Need&);
  const char* how;
};

constexpr double kSoftKernel = 2.5;  // by which Unity multiplies both of its biases where a light's shadows are soft
constexpr double kSoftLow = 2.0;     // the radius by which Godot multiplies its bias at its default quality

constexpr EngineSetting kSettings[] = {
    {"three.js bias", "constant", [](const Need& need) { return -need.depth; },
     "three.js adds `bias` to the receiver's depth in [0,1]; less is nearer to the light (LightShadow, "
     "shadowmap_pars_fragment)."},
    {"Unity URP Depth Bias", "constant", [](const Need& need) { return need.texels / kSoftKernel; },
     "Unity's universal pipeline moves casters away from the light by so many texels, 2.5 times as far for soft "
     "shadows, which stand here (ShadowUtils.GetShadowBias, Shadows.hlsl). It sets glPolygonOffset(2.5, 1) besides."},
    {"Godot Bias", "constant", [](const Need& need) { return 100.0 * need.depth / kSoftLow; },
     "Godot moves receivers towards the light by a hundredth of it times the depth range, the light's blur (1 by "
     "default) and the radius of its quality, 2 at Soft Low, the default (light_storage.cpp, 4.x)."},
    {"Filament constantBias", "constant", [](const Need& need) { return need.metres; },
     "Filament takes metres (LightManager::ShadowOptions)."},
    {"three.js normalBias", "normal-offset", [](const Need& need) { return need.setting * need.texel_m * need.sine; },
     "three.js moves receivers along the normal by so many metres at every angle (shadowmap_vertex)."},
    {"Unity URP Normal Bias", "normal-offset",
     [](const Need& need) { return need.setting * need.sine / (1.0 - need.cosine) / kSoftKernel; },
     "Unity moves casters along the normal by so many texels times 1 - n.l, 2.5 times as far for soft shadows."},
    {"Godot Normal Bias", "normal-offset",
     [](const Need& need) { return need.setting / (need.sine * (1.0 - need.cosine)); },
     "Godot moves receivers along the normal by so many texels times 1 - n.l, less the part along the light "
     "(scene_forward_clustered.glsl)."},
    {"Filament normalBias", "normal-offset", [](const Need& need) { return 2.0 * need.setting; },
     "Filament moves receivers along the normal by half of it in texels, times the sine of the angle to the light "
     "(ShadowMapManager.cpp, light_space.fs)."},
    {"glPolygonOffset factor", "polygon-offset", [](const Need& need) { return need.setting; },
     "The factor, with no units."}};

std::optional<Need> find_need(const records::BiasSweepRecord& sweep, const char* mode, const std::string& filter) {
  const auto swept = std::ranges::find(sweep.modes, mode, &records::BiasModeRecord::mode);
  if (swept == sweep.modes.end()) return std::nullopt;
  const auto curve = std::ranges::find(swept->curves, filter, &records::BiasCurve::filter);
  const auto enough = curve == swept->curves.end() ? std::nullopt : find_enough(*curve);
  if (!enough) return std::nullopt;
  const double angle = sweep.angle_deg * std::numbers::pi / 180.0;
  return Need{*enough * curve->theory_setting,
              *enough * curve->lift_depth,
              *enough * curve->lift_texels,
              *enough * curve->lift_m,
              sweep.texel_m.most,
              std::sin(angle),
              std::cos(angle)};
}

}  // namespace

document::Section make_engine_section(const records::BiasSweepRecord& sweep) {
  document::Section section{"engines", "In the units of engines", {}};
  if (sweep.texel_m.least < (1.0 - 1e-6) * sweep.texel_m.most) {
    section.blocks.emplace_back(
        document::Paragraph{"Left out: texels differ in size, as under a lamp or in cascades, and each engine "
                            "approximates that in its own way."});
    return section;
  }
  records::TextTable table{{"filter"}, {}};
  std::vector<std::string> how;
  for (const EngineSetting& setting : kSettings) {
    table.header.emplace_back(setting.name);
    how.push_back(fmt::format("{}, from {}: {}", setting.name, setting.mode, setting.how));
  }
  for (const std::string& filter : sweep.filters) {
    table.rows.push_back({filter});
    for (const EngineSetting& setting : kSettings) {
      const auto need = find_need(sweep, setting.mode, filter);
      table.rows.back().push_back(need ? fmt::format("{:.3g}", setting.convert(*need) + 0.0) : records::kNothing);
    }
  }
  section.blocks.emplace_back(document::Paragraph{
      fmt::format("The least amount swept without acne, where no other bias is set. Settings that grow with the angle "
                  "to the light are equal at {:.3g} degrees, that of the steepest lit surfaces.",
                  sweep.angle_deg),
      true});
  section.blocks.emplace_back(document::Table{"", std::move(table)});
  section.blocks.emplace_back(document::Details{"How these are converted", {document::Sentences{{}, std::move(how)}}});
  return section;
}

}  // namespace shadowbench::pages
