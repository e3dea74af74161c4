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
  list_filters(state);
  return state;
}

void set_light(ViewState& state, const scene::Light& light) { state.scene.light = state.lights[state.light] = light; }

void choose_light(ViewState& state, std::size_t light) {
  state.light = light;
  state.scene.light = state.lights[light];
}

void list_filters(ViewState& state) {
  std::vector<filters::FilterRequest>& listed = state.options.filters;
  listed.clear();
  for (const Side& side : state.sides) {
    if (side.truth) continue;
    if (listed.empty() || listed.front().spec.id != side.filter.spec.id || listed.front().values != side.filter.values)
      listed.push_back(side.filter);
  }
}

}  // namespace shadowbench::view
