#include "harness/view/view_state.h"

#include <utility>

#include "harness/run/scene_loading.h"

namespace shadowbench::view {

ViewState make_view_state(options::RunOptions options, const std::string& scene_argument,
                          std::array<Side, kSides> sides) {
  ViewState state;
  state.options = std::move(options);
  state.scene_argument = scene_argument;
  state.scene = run::load_scene(state.options, scene_argument);
  state.cameras = state.scene.cameras;
  state.lights = {state.scene.light};
  for (scene::Light& light : state.scene.other_lights) state.lights.push_back(std::move(light));
  state.scene.other_lights.clear();
  state.sides = std::move(sides);
  apply(state, state);
  return state;
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

void check(const ViewSettings& settings) {
  render::require_drawable(settings.options.bias, settings.options.map);
  for (const Side& side : settings.sides)
    if (!side.truth) render::require_usable(settings.options.bias, side.filter.spec);
}

}  // namespace shadowbench::view
