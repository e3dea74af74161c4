#include "harness/view/view_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/nearest_name.h"
#include "harness/render/gbuffer.h"
#include "harness/run/scene_loading.h"

namespace shadowbench::view {

Side make_side(const filters::Catalogue& catalogue, const std::string& text) {
  const bool truth = text == kTruthName;
  const std::vector<filters::FilterRequest> requests = catalogue.parse_requests(truth ? "none" : text);
  filters::refuse_light_widths(requests);
  if (requests.size() != 1)
    throw Error(ErrorKind::kUsage,
                fmt::format("'{}' names {} filters: a side shows one, or '{}'", text, requests.size(), kTruthName));
  return {requests.front(), truth};
}

ViewState make_view_state(options::RunOptions options, const std::string& scene_argument,
                          std::array<Side, kSides> sides) {
  ViewState state;
  state.options = std::move(options);
  state.scene_argument = scene_argument;
  state.scene = run::load_scene(state.options, scene_argument);
  state.cameras = state.scene.cameras;
  for (scene::Camera& camera : state.cameras) camera.light.clear();  // from each, any light is looked at
  state.lights = {state.scene.light};
  for (scene::Light& light : state.scene.other_lights) state.lights.push_back(std::move(light));
  state.scene.other_lights.clear();
  state.sides = std::move(sides);
  apply(state, state);
  return state;
}

void choose_light(ViewState& state, const std::string& name) {
  std::vector<std::string> names;
  for (const scene::Light& light : state.lights) names.push_back(light.name);
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw Error(ErrorKind::kUsage, fmt::format("--light-name: '{}' is no light of {}{}", name, state.scene.name,
                                               did_you_mean_or_known(name, names)));
  state.light = static_cast<std::size_t>(found - names.begin());
  const auto view = std::ranges::find_if(
      state.scene.cameras, [&](const scene::Camera& each) { return each.light.empty() || each.light == name; });
  state.camera = static_cast<std::size_t>(view - state.scene.cameras.begin());
  apply(state, state);
}

void apply(ViewState& state, ViewSettings settings) {
  std::vector<filters::FilterRequest>& listed = settings.options.filters;
  listed.clear();
  for (const Side& side : settings.sides) {
    if (side.truth) continue;
    if (listed.empty() || !filters::is_same(listed.front(), side.filter)) listed.push_back(side.filter);
  }
  static_cast<ViewSettings&>(state) = std::move(settings);
  state.scene.light = state.lights[state.light];
}

void set_fit(ViewSettings& settings, const std::string& text) {
  settings.options.fit = scene::parse_fit_rule(text);
  settings.options.fits = {settings.options.fit};
}

void set_bias(ViewSettings& settings, const std::vector<std::string>& texts) {
  settings.options.bias = render::parse_bias(texts);
  settings.options.bias_texts = texts;
}

void halve(ViewSettings& settings, bool map) {
  options::RunOptions& options = settings.options;
  options.width = std::max(options.width / 2, 1);
  options.height = std::max(options.height / 2, 1);
  options.sizes = {{options.width, options.height}};
  if (!map) return;
  options.map_sizes = {std::max(settings.map_size() / 2, 1)};
  for (Side& side : settings.sides) {
    const auto* radius = std::get_if<std::string>(&side.filter.spec.radius_texels);
    const filters::ParamSpec* param = radius ? side.filter.spec.find_param(*radius) : nullptr;
    double* value = param ? std::get_if<double>(&side.filter.values.at(*radius)) : nullptr;
    if (!value || !param->choices.empty()) continue;
    *value = std::max(param->integer ? std::round(0.5 * *value) : 0.5 * *value, param->min.value_or(0.0));
  }
}

glm::vec2 find_place(const ViewState& state, const glm::vec3& point_ws) {
  const double aspect = static_cast<double>(state.options.width) / static_cast<double>(state.options.height);
  const glm::vec4 clip =
      render::clip_from_world(state.active_camera(), state.scene.bounds(), aspect) * glm::vec4(point_ws, 1.0f);
  return glm::vec2(0.5f) + glm::vec2(0.5f, -0.5f) * glm::vec2(clip) / clip.w;
}

void check(const ViewSettings& settings) {
  render::require_drawable(settings.options.bias, settings.options.map);
  for (const Side& side : settings.sides)
    if (!side.truth) render::require_usable(settings.options.bias, side.filter.spec);
}

}  // namespace shadowbench::view
