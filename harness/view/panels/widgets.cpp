#include "harness/view/panels/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <cstdint>

#include "harness/render/picture_passes.h"
#include "harness/tune/param_scale.h"

namespace shadowbench::view {
namespace {

constexpr float kWidgetWidth = 0.55f;  ///< of the panel's; the label has the rest

std::string label_of(const std::string& name, const std::string& label) { return label + "##" + name; }

void begin_widget() { ImGui::SetNextItemWidth(kWidgetWidth * ImGui::GetContentRegionAvail().x); }

/// A unit as a format shows it: a percent sign would begin a number.
std::string format_of(const Widgets::SliderLimits& limits) {
  std::string unit = limits.unit.empty() ? "" : " " + limits.unit;
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

}  // namespace shadowbench::view
