#include "harness/view/settings_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

#include "base/error.h"
#include "harness/gl/objects.h"
#include "harness/render/bias.h"
#include "harness/scene/load.h"
#include "harness/tune/tuning.h"
#include "harness/view/layers.h"
#include "harness/view/picture_input.h"

namespace shadowbench::view {
namespace {

constexpr float kWidgetWidth = 0.55f;  ///< of the panel's; the label has the rest

std::string label_of(const std::string& name, const std::string& label) { return label + "##" + name; }

void begin_widget() { ImGui::SetNextItemWidth(kWidgetWidth * ImGui::GetContentRegionAvail().x); }

/// A unit as a format shows it: a percent sign would begin a number.
std::string format_of(const Widgets::SliderLimits& limits) {
  std::string unit = limits.unit.empty() || limits.unit == "1" ? "" : " " + limits.unit;
  for (std::size_t i = unit.find('%'); i != std::string::npos; i = unit.find('%', i + 2)) unit.insert(i, "%");
  return (limits.integer ? "%.0f" : "%.4g") + unit;
}

std::string describe(const filters::ParamSpec& spec) {
  std::string text = spec.text;
  if (spec.min && spec.max)
    text += fmt::format("\n{:g} .. {:g}{}", *spec.min, *spec.max, spec.integer ? ", whole" : "");
  if (!spec.unit.empty()) text += "\nunit: " + spec.unit;
  text += "\ndefault: " + filters::to_string(spec.default_value);
  if (spec.is_const) text += "\nA constant of the shader: changing it compiles the filter anew.";
  return text;
}

}  // namespace

void show_help(const std::string& text) {
  if (text.empty() || !ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(28.0f * ImGui::GetFontSize());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void Widgets::note(const std::string& name) {
  const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
  log_.note_widget(name, {least.x, least.y}, {most.x, most.y});
}

void Widgets::finish(const std::string& name, const std::string& help) {
  note(name);
  show_help(help);
}

bool Widgets::choose(const std::string& name, const std::string& label, const std::vector<std::string>& choices,
                     std::size_t& chosen, const std::string& help) {
  bool changed = false;
  begin_widget();
  const bool open =
      ImGui::BeginCombo(label_of(name, label).c_str(), choices[chosen].c_str(), ImGuiComboFlags_HeightLarge);
  if (!open) {  // else the last item is one of the list's
    finish(name, help);
    return false;
  }
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const bool pressed = ImGui::Selectable(choices[i].c_str(), i == chosen);
    note(name + "=" + choices[i]);
    if (pressed && i != chosen) {
      chosen = i;
      changed = true;
    }
  }
  ImGui::EndCombo();
  return changed;
}

bool Widgets::slide(const std::string& name, const std::string& label, const SliderLimits& limits, double& value,
                    const std::string& help) {
  double shown = value;
  ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
  if (limits.logarithmic) flags |= ImGuiSliderFlags_Logarithmic;
  begin_widget();
  bool changed = ImGui::SliderScalar(label_of(name, label).c_str(), ImGuiDataType_Double, &shown, &limits.min,
                                     &limits.max, format_of(limits).c_str(), flags);
  finish(name, help);
  if (limits.integer) shown = std::round(shown);
  changed = changed && shown != value;
  value = shown;
  return changed;
}

bool Widgets::drag(const std::string& name, const std::string& label, const std::string& unit, float& value,
                   float speed) {
  begin_widget();
  const bool changed =
      ImGui::DragFloat(label_of(name, label).c_str(), &value, speed, 0.0f, 0.0f, ("%.4g " + unit).c_str());
  finish(name, {});
  return changed && std::isfinite(value);
}

bool Widgets::tick(const std::string& name, const std::string& label, bool& value, const std::string& help) {
  const bool changed = ImGui::Checkbox(label_of(name, label).c_str(), &value);
  finish(name, help);
  return changed;
}

bool Widgets::press(const std::string& name, const std::string& label, const std::string& help) {
  const bool pressed = ImGui::Button(label_of(name, label).c_str());
  finish(name, help);
  return pressed;
}

void Widgets::show(const std::string& name, const gl::Texture& texture) {
  ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.id())),
               {static_cast<float>(texture.width()), static_cast<float>(texture.height())}, {0.0f, 1.0f}, {1.0f, 0.0f});
  note(name);
}

bool Widgets::parameter(const std::string& name, const filters::ParamSpec& spec, filters::ParamValue& value) {
  const std::string help = describe(spec);
  if (!spec.choices.empty()) {
    std::vector<std::string> choices;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < spec.choices.size(); ++i) {
      choices.push_back(filters::to_string(spec.choices[i]));
      if (spec.choices[i] == value) chosen = i;
    }
    if (!choose(name, spec.name, choices, chosen, help)) return false;
    value = spec.choices[chosen];
    return true;
  }
  if (bool* flag = std::get_if<bool>(&value)) return tick(name, spec.name, *flag, help);
  double* number = std::get_if<double>(&value);
  if (!number || !spec.min || !spec.max) {
    ImGui::TextDisabled("%s = %s", spec.name.c_str(), filters::to_string(value).c_str());
    return false;
  }
  const double usual = std::get<double>(spec.default_value);
  const bool is_linear = *spec.min >= *spec.max ||
                         tune::ParamScale({spec.name, *spec.min, *spec.max, usual, spec.integer}).name() == "linear";
  return slide(
      name, spec.name,
      {.min = *spec.min, .max = *spec.max, .logarithmic = !is_linear, .integer = spec.integer, .unit = spec.unit},
      *number, help);
}

ScenePanel::ScenePanel(Workbench& bench, Widgets widgets) : bench_(bench), widgets_(widgets) {
  const options::Resources& resources = bench.state().options.resources;
  for (const auto& scenes : {scene::list_scenes(resources.scenes), scene::list_teaching_scenes(resources.scenes)})
    for (const scene::SceneInfo& info : scenes) scenes_.push_back(info.name);
  const std::string& own = bench.state().scene_argument;
  if (std::ranges::count(scenes_, own) == 0) scenes_.insert(scenes_.begin(), own);
  lessons_ = read_lessons(resources.lessons);
}

const Lesson* ScenePanel::lay_out() {
  if (!ImGui::CollapsingHeader("Scene and lesson", ImGuiTreeNodeFlags_DefaultOpen)) return nullptr;
  choose_scene();
  std::vector<std::string> titles = {"none"};
  for (const Lesson& lesson : lessons_) titles.push_back(lesson.title);
  if (widgets_.choose("lesson", "lesson", titles, lesson_, "A fault, with the settings that show it."))
    return start_lesson();
  return lesson_ == 0 ? nullptr : show_lesson();
}

void ScenePanel::choose_scene() {
  const ViewState& state = bench_.state();
  auto chosen = static_cast<std::size_t>(std::ranges::find(scenes_, state.scene_argument) - scenes_.begin());
  if (!widgets_.choose("scene", "scene", scenes_, chosen, state.scene.title)) return;
  try {
    bench_.show(make_view_state(state.options, scenes_[chosen], state.sides));
    lesson_ = 0;
  } catch (const Error& error) {
    bench_.say(error.what());
  }
}

const Lesson* ScenePanel::start(const std::string& name) {
  lesson_ = static_cast<std::size_t>(std::ranges::find(lessons_, name, &Lesson::name) - lessons_.begin()) + 1;
  return start_lesson();
}

const Lesson* ScenePanel::start_lesson() {
  is_instead_ = false;
  if (lesson_ == 0) return nullptr;
  const Lesson& lesson = lessons_[lesson_ - 1];
  try {
    bench_.show(make_lesson_state(lesson, bench_.state().options, bench_.catalogue()));
    return &lesson;
  } catch (const Error& error) {
    bench_.say(error.what());
    lesson_ = 0;
    return nullptr;
  }
}

/// The text, and what can be done.
const Lesson* ScenePanel::show_lesson() {
  const Lesson& lesson = lessons_[lesson_ - 1];
  ImGui::PushTextWrapPos();
  for (const std::string& sentence : lesson.sentences) ImGui::TextUnformatted(sentence.c_str());
  ImGui::PopTextWrapPos();
  if (!lesson.instead_title.empty() &&
      widgets_.tick("lesson.instead", lesson.instead_title, is_instead_, "The remedy that the lesson names."))
    bench_.change(Changes::all(), [&](ViewSettings& settings) {
      set_shared(settings, is_instead_ ? lesson.instead : lesson.settings);
    });
  return widgets_.press("lesson.again", "begin this lesson again", "Sets everything as the lesson has it.")
             ? start_lesson()
             : nullptr;
}

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
  if (!begin_section("View")) return;
  std::vector<std::string> titles;
  for (const Layer& layer : Layers::list()) titles.push_back(layer.title);
  widgets_.choose("layer", "layer", titles, look.layer, Layers::list()[look.layer].text);
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
  if (widgets_.choose("fit", "fit", fits, fit, "The region that the light's map covers."))
    bench_.change({.map = true}, [&](ViewSettings& settings) { set_fit(settings, fits[fit]); });
  bool snap = state.options.snap;
  if (widgets_.tick("snap", "snap to texels", snap, "Keeps the map's texels fixed in the world while the view moves."))
    bench_.change({.light = true}, [&](ViewSettings& settings) { settings.options.snap = snap; });
}

void SettingsPanel::show_bias() {
  const std::vector<std::string>& texts = bench_.state().options.bias_texts;
  std::vector<std::string> modes = {"default"};
  for (const render::BiasMode& mode : render::bias_modes()) modes.push_back(mode.name);
  const std::string current = texts.empty() ? "default" : texts.front().substr(0, texts.front().find(':'));
  std::size_t chosen = find_index(modes, current);
  const bool other = widgets_.choose("bias", "bias", modes, chosen);
  const auto mode = std::ranges::find(render::bias_modes(), modes[chosen], &render::BiasMode::name);
  const bool has_amount = mode != render::bias_modes().end() && !mode->key.empty();
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
