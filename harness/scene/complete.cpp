#include "harness/scene/complete.h"

#include <algorithm>
#include <utility>

#include "harness/scene/framing.h"
#include "harness/scene/validate.h"
#include "harness/scene/view_choice.h"

namespace shadowbench::scene {
namespace {

Scene with_floor(Scene scene, float ground_y) {
  Material material;
  material.name = "ground";
  material.base_color = {0.42f, 0.40f, 0.37f, 1.0f};
  scene.floor = place_floor(scene, ground_y);
  Mesh mesh = make_floor(*scene.floor);
  mesh.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

/// Adds the usual sun and camera, where they are free, and puts the lights where they were asked for.
Scene with_usual_view(Scene scene, const ViewFreedom& free, const Completion& completion) {
  const ViewAngles usual = usual_view(scene.bounds());
  if (completion.needs_sun) scene.light = place_in_sky({}, usual.sun);
  const auto place = [&](Light& light) {
    if (completion.light) light = place_in_sky(light, *completion.light);
  };
  place(scene.light);
  std::ranges::for_each(scene.other_lights, place);
  if (free.camera) scene.cameras.push_back(frame_camera(scene, usual.camera, completion.aspect, free.ground_y));
  return scene;
}

Scene with_chosen_view(Scene scene, const ViewFreedom& free, double aspect) {
  const ViewChoice choice = choose_view(scene, free);
  if (free.sun) scene.light = place_in_sky(scene.light, choice.angles.sun);
  if (free.camera) scene.cameras = {frame_camera(scene, choice.angles.camera, aspect, free.ground_y)};
  (choice.shows_edges() ? scene.notes : scene.warnings).push_back(describe_choice(choice, free));
  return scene;
}

}  // namespace

Scene complete(Scene scene, const Completion& completion, const std::string& where) {
  ViewFreedom free{.camera = scene.cameras.empty(), .sun = completion.needs_sun && !completion.light};
  if (completion.ground) free.ground_y = ground_height(scene);
  scene = validate(with_usual_view(std::move(scene), free, completion), where);
  if (free.camera || free.sun) scene = with_chosen_view(std::move(scene), free, completion.aspect);
  return free.ground_y ? with_floor(std::move(scene), *free.ground_y) : scene;
}

}  // namespace shadowbench::scene
