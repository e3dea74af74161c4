#include "harness/view/panels/settings_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "base/error.h"
#include "harness/gl/objects.h"
#include "harness/render/bias.h"
#include "harness/view/controls.h"
#include "harness/view/layers.h"

namespace shadowbench::view {
namespace {

constexpr const char* kTruth = "ray-traced truth";

bool begin_section(const std::string& title, bool open = true) {
  return ImGui::CollapsingHeader(title.c_str(), open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

std::size_t find_index(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()) % names.size();
}

/// The limits of a mode's amount, by the unit that it is given in.
Widgets::SliderLimits bias_limits(const std::string& key) {
  if (key == "depth") return {.min = 1e-6, .max = 0.1, .logarithmic = true, .unit = key};
  return {.max = 10.0, .unit = key};
}

/// The amount in "constant:depth=0.025"; nothing where another unit stands there, or more than that.
std::optional<double> find_amount(const std::vector<std::string>& texts, const std::string& key) {
  if (texts.size() != 1) return std::nullopt;
  const std::size_t begin = texts.front().find(":" + key + "=");
  if (begin == std::string::npos) return std::nullopt;
  return std::strtod(texts.front().c_str() + begin + key.size() + 2, nullptr);
}

}  // namespace

SettingsPanel::SettingsPanel(Workbench& bench, Widgets widgets, std::function<void()> save_scene)
    : bench_(bench), widgets_(widgets), save_scene_(std::move(save_scene)) {}

void SettingsPanel::lay_out(Look& look) {
  choices_ = {kTruth};
  for (const filters::FilterSpec& spec : bench_.catalogue().filters()) choices_.push_back(spec.id);
  show_look(look);
  for (std::size_t side = 0; side < kSides; ++side) show_side(side);
  show_light();
  show_map();
  show_camera();
}

void SettingsPanel::show_look(Look& look) {
  if (!begin_section("What is shown")) return;
  std::vector<std::string> titles;
  for (const Layer& layer : Layers::list()) titles.push_back(layer.title);
  widgets_.choose("layer", "layer", titles, look.layer, Layers::list()[look.layer].text);
  std::size_t sharing = look.sharing == Sharing::kDivider ? 0 : 1;
  if (widgets_.choose("sharing", "sides", {"divider", "one at a time (Space)"}, sharing))
    look.sharing = sharing == 0 ? Sharing::kDivider : Sharing::kFlip;
  double scale = static_cast<double>(look.error_scale);
  if (widgets_.slide("error_scale", "full colour at", {.min = 0.001, .logarithmic = true}, scale,
                     "The error of visibility that gets the full red or blue."))
    look.error_scale = static_cast<float>(scale);
}

void SettingsPanel::show_side(std::size_t side) {
  const Side& shown = bench_.state().sides[side];
  const std::string name = kSideNames[side];
  const std::string title = shown.truth ? kTruth : shown.filter.spec.title;
  ImGui::PushID(static_cast<int>(side));
  if (begin_section(fmt::format("{}: {}###{}", name, title, name))) {
    std::size_t chosen = find_index(choices_, shown.truth ? kTruth : shown.filter.spec.id);
    if (widgets_.choose(name + ".filter", "filter", choices_, chosen, shown.truth ? "" : shown.filter.spec.source))
      choose_side(side, choices_[chosen]);
    for (std::size_t i = 0; !shown.truth && i < shown.filter.spec.params.size(); ++i) {
      const filters::ParamSpec spec = shown.filter.spec.params[i];
      filters::ParamValue value = shown.filter.values.at(spec.name);
      if (!widgets_.parameter(name + "." + spec.name, spec, value)) continue;
      Changes changes;
      const bool compiles = spec.is_const || std::holds_alternative<std::string>(value);
      (compiles ? changes.filter : changes.values)[side] = true;
      bench_.change(changes, [&](ViewSettings& settings) {
        filters::FilterRequest& filter = settings.sides[side].filter;
        filter.values[spec.name] = value;
        filter.set_by_user.insert(spec.name);
      });
    }
  }
  ImGui::PopID();
}

void SettingsPanel::choose_side(std::size_t side, const std::string& choice) {
  Changes changes;
  changes.filter[side] = true;
  bench_.change(changes, [&](ViewSettings& settings) {
    Side& chosen = settings.sides[side];
    chosen.truth = choice == kTruth;
    if (!chosen.truth) chosen.filter = bench_.request(choice);
  });
}

void SettingsPanel::show_light() {
  if (!begin_section("Light")) return;
  const ViewState& state = bench_.state();
  if (state.lights.size() > 1) {
    std::vector<std::string> names;
    for (const scene::Light& light : state.lights) names.push_back(light.name);
    std::size_t chosen = state.light;
    if (widgets_.choose("light", "light", names, chosen))
      bench_.change(Changes::all(), [&](ViewSettings& settings) { settings.light = chosen; });
  }
  const scene::SkyAngles at = find_in_sky(state.scene.light);
  double azimuth = at.azimuth_deg, elevation = at.elevation_deg;
  const bool turned = widgets_.slide("azimuth", "azimuth", {.min = -180.0, .max = 180.0, .unit = "degrees"}, azimuth,
                                     "0 is +z, 90 is +x.");
  const bool raised =
      widgets_.slide("elevation", "elevation", {.min = -90.0, .max = 90.0, .unit = "degrees"}, elevation);
  scene::Light light = state.scene.light;
  if (turned || raised) light = scene::place_in_sky(light, {azimuth, elevation});
  bool changed = turned || raised;
  for (const scene::LightSlider& number : scene::list_sliders(light)) {
    const std::string name = "light." + number.name;
    if (!number.range) {
      changed |= widgets_.drag(name, number.name, number.unit, *number.value, 0.02f);
      continue;
    }
    double value = static_cast<double>(*number.value);
    if (!widgets_.slide(name, number.name, {.min = number.range->min, .max = number.range->max, .unit = number.unit},
                        value))
      continue;
    *number.value = static_cast<float>(value);
    changed = true;
  }
  if (changed) bench_.change({.light = true}, [&](ViewSettings& settings) { settings.lights[settings.light] = light; });
  if (widgets_.press("light.save", "save as a scene (Ctrl+S)",
                     "Writes a scene file with this light and camera; `shadowbench view` and `run --scene` take it."))
    save_scene_();
}

void SettingsPanel::show_map() {
  if (!begin_section("Shadow map")) return;
  const ViewState& state = bench_.state();
  std::vector<std::string> sizes;
  for (int size = 128; size <= 8192; size *= 2) sizes.push_back(std::to_string(size));
  const std::string own = std::to_string(state.map_size());
  if (std::ranges::find(sizes, own) == sizes.end()) sizes.insert(sizes.begin(), own);
  std::size_t size = find_index(sizes, own);
  if (widgets_.choose("map_size", "texels a side", sizes, size))
    bench_.change({.map = true},
                  [&](ViewSettings& settings) { settings.options.map_sizes = {std::stoi(sizes[size])}; });
  const std::vector<std::string> formats = {"d16", "d24", "d32f"};
  std::size_t format = 0;
  for (std::size_t i = 0; i < formats.size(); ++i)
    if (gl::parse_depth_format(formats[i]).internal_format == state.options.map.format) format = i;
  if (widgets_.choose("map_format", "format", formats, format))
    bench_.change({.map = true}, [&](ViewSettings& settings) {
      settings.options.map.format = gl::parse_depth_format(formats[format]).internal_format;
    });
  bool reversed = state.options.map.curve.reversed;
  if (widgets_.tick("reversed_depth", "reversed depth", reversed))
    bench_.change({.map = true}, [&](ViewSettings& settings) { settings.options.map.curve.reversed = reversed; });
  show_fit();
  show_bias();
}

void SettingsPanel::show_fit() {
  const ViewState& state = bench_.state();
  const std::vector<std::string> fits = scene::list_fit_names();
  std::size_t fit = find_index(fits, std::string(scene::name_of(state.options.fit.mode)));
  if (widgets_.choose("fit", "fit", fits, fit, "What the light's map encloses."))
    bench_.change({.map = true}, [&](ViewSettings& settings) { set_fit(settings, fits[fit]); });
  bool snap = state.options.snap;
  if (widgets_.tick("snap", "snap to texels", snap, "Keeps the map's texels fixed in the world while the view moves."))
    bench_.change({.light = true}, [&](ViewSettings& settings) { settings.options.snap = snap; });
}

void SettingsPanel::show_bias() {
  const std::vector<std::string>& texts = bench_.state().options.bias_texts;
  std::vector<std::string> modes = {"default", "none"};
  for (const render::SweptMode& mode : render::swept_modes()) modes.push_back(mode.name);
  const std::string current = texts.empty() ? "default" : texts.front().substr(0, texts.front().find(':'));
  std::size_t chosen = find_index(modes, current);
  const bool other = widgets_.choose("bias", "bias", modes, chosen);
  const auto mode = std::ranges::find(render::swept_modes(), modes[chosen], &render::SweptMode::name);
  const bool has_amount = mode != render::swept_modes().end() && !mode->key.empty();
  bool changed = other;
  if (has_amount) {
    const Widgets::SliderLimits limits = bias_limits(mode->key);
    bias_amount_ = find_amount(texts, mode->key).value_or(bias_amount_);
    if (other) bias_amount_ = limits.logarithmic ? 1e-3 : 1.0;
    changed |= widgets_.slide("bias.amount", mode->key, limits, bias_amount_, mode->meaning);
  }
  if (!changed) return;
  std::vector<std::string> wanted;
  if (modes[chosen] != "default")
    wanted = {has_amount ? fmt::format("{}:{}={}", mode->name, mode->key, bias_amount_) : modes[chosen]};
  bench_.change({.map = true}, [&](ViewSettings& settings) { set_bias(settings, wanted); });
}

void SettingsPanel::show_camera() {
  if (!begin_section("Camera", false)) return;
  const ViewState& state = bench_.state();
  std::vector<std::string> names;
  for (const scene::Camera& camera : state.cameras) names.push_back(camera.name);
  std::size_t chosen = state.camera;
  if (widgets_.choose("camera", "camera", names, chosen))
    bench_.change({.camera = true}, [&](ViewSettings& settings) { settings.camera = chosen; });
  const scene::Camera& camera = state.active_camera();
  double fov = glm::degrees(static_cast<double>(camera.vertical_fov_rad));
  if (camera.orthographic_height_m <= 0.0f &&
      widgets_.slide("fov", "field of view", {.min = 5.0, .max = 120.0, .unit = "degrees"}, fov, "Vertical."))
    bench_.change({.camera = true}, [&](ViewSettings& settings) {
      settings.cameras[settings.camera].vertical_fov_rad = static_cast<float>(glm::radians(fov));
    });
  const glm::dvec3 place = glm::dvec3(camera.position_ws) + state.scene.origin_ws;
  ImGui::TextDisabled("at %.3g %.3g %.3g", place.x, place.y, place.z);
}

}  // namespace shadowbench::view
