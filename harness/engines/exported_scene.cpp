#include "harness/engines/exported_scene.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <sstream>

#include "base/files.h"
#include "base/folder_lock.h"
#include "harness/run/provenance.h"
#include "harness/run/task_images.h"
#include "harness/scene/files/mesh_file.h"
#include "reference/truth/cached_tracer.h"
#include "report/records/json_values.h"

namespace shadowbench::engines {
namespace {

using Json = nlohmann::ordered_json;

/// A model's scene is called like its file.
std::string model_name(const run::PlannedScene& planned) { return make_file_stem(planned.scene.name) + ".glb"; }

Json list(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Columns first, as OpenGL and WebGL take it.
Json list(const glm::dmat4& matrix) { return std::vector<double>(glm::value_ptr(matrix), glm::value_ptr(matrix) + 16); }

Json camera_json(const scene::Camera& camera) {
  const scene::ViewAxes axes(camera);
  Json json = {{"position", list(axes.eye)},
               {"forward", list(axes.forward)},
               {"right", list(axes.right)},
               {"up", list(axes.up)}};
  if (camera.orthographic_height_m > 0.0f)
    json["orthographic_height"] = camera.orthographic_height_m;
  else
    json["vertical_fov_deg"] = glm::degrees(static_cast<double>(camera.vertical_fov_rad));
  return json;
}

Json light_json(const scene::Light& light) {
  const scene::GltfLight shape = scene::describe_gltf_light(light);
  Json json = {{"type", shape.type}};
  if (scene::find_beam(light)) json["position"] = list(shape.position_ws);
  if (shape.type != "point") json["direction"] = list(shape.direction_ws);
  json["color"] = list(glm::dvec3(light.color));
  std::ostringstream rest;
  rest << toml::json_formatter(scene::list_gltf_extras(light));
  json.update(Json::parse(rest.str()));
  return json;
}

/// The depth of a clip space in [0,1] as one in [-1,1], which WebGL has.
glm::dmat4 to_gl_clip(const glm::dmat4& clip_from_world) {
  glm::dmat4 wider(1.0);
  wider[2][2] = 2.0;
  wider[3][2] = -1.0;
  return wider * clip_from_world;
}

Json describe_layer(const scene::LightFrustum& layer) {
  Json json;
  json["clip_from_world"] = list(to_gl_clip(layer.clip_from_light * layer.light_from_world));
  json["texel"] = layer.texel_size_ws;
  const glm::dmat4& clip = layer.clip_from_light;
  const glm::dmat4 world_from_light = glm::inverse(layer.light_from_world);
  const auto axis = [&](int column) { return glm::dvec3(world_from_light[column]); };
  const bool is_window = layer.shape == scene::MapShape::kPlane;
  json["kind"] = !is_window ? "matrix" : layer.perspective ? "perspective" : "orthographic";
  if (!is_window) return json;
  json["eye"] = list(axis(3));
  json["right"] = list(axis(0));
  json["up"] = list(axis(1));
  json["forward"] = list(-axis(2));
  if (layer.perspective) {
    json["vertical_fov_deg"] = glm::degrees(2.0 * std::atan(1.0 / clip[1][1]));
    json["near"] = layer.perspective->near_m;
    json["far"] = layer.perspective->far_m;
    return json;
  }
  // Where x, y and z of clip space take their least and greatest value.
  json["width"] = layer.width_ws;
  for (const auto& [name, row, value] : {std::tuple("left", 0, -1.0), std::tuple("right_side", 0, 1.0),
                                         std::tuple("bottom", 1, -1.0), std::tuple("top", 1, 1.0)})
    json[name] = (value - clip[3][row]) / clip[row][row];
  json["near"] = clip[3][2] / clip[2][2];
  json["far"] = (1.0 - clip[3][2]) / -clip[2][2];
  return json;
}

}  // namespace

Json describe_view(const run::PlannedScene& planned, const scene::Camera& camera) {
  const options::RunOptions& options = planned.options;
  Json json = {{"version", kSceneVersion},
               {"program", run::build_commit()},
               {"scene", planned.scene.name},
               {"title", planned.scene.title},
               {"view", camera.name},
               {"model", model_name(planned)},
               {"units", "metres, degrees; right-handed, +y up; matrices are columns first, clip space is -1 .. 1"},
               {"origin", list(planned.scene.origin_ws)},
               {"width", options.width},
               {"height", options.height},
               {"truth", run::name_view(planned, camera)}};
  json["camera"] = camera_json(camera);
  json["light"] = light_json(planned.scene.light);
  json["maps"] = Json::array();
  return json;
}

Json describe_map(const run::PlannedScene& planned, int map_size, const std::vector<scene::LightFrustum>& layers) {
  Json json = {{"fit", scene::describe_fit(planned.options.fit)}, {"size", map_size}, {"layers", Json::array()}};
  for (const scene::LightFrustum& layer : layers) json["layers"].push_back(describe_layer(layer));
  return json;
}

void write_exported_scene(const std::filesystem::path& folder, const run::PlannedScene& planned,
                          const scene::Camera& camera, const Json& description) {
  scene::Scene seen = planned.scene;
  seen.cameras = {camera};
  const double aspect = static_cast<double>(planned.options.width) / planned.options.height;
  write_text_file(folder / model_name(planned), scene::write_glb(seen, aspect));
  write_text_file(folder / "scene.json", description.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

ExportedScenes export_scenes(const options::RunOptions& options, options::Progress& progress) {
  measure::Renderer renderer = measure::make_renderer(options.backend, options.resources);
  const FolderLock lock(options.out, options.force);
  truth::TruthCache cache(options.cache, [&](const std::string& message) { progress.note("warning: " + message); });
  const run::RunPlan plan = run::make_plan(options, renderer.context->info().renderer);
  ExportedScenes exported;
  const auto warn = [&](const std::string& message) {
    if (std::ranges::count(exported.warnings, message) > 0) return;
    exported.warnings.push_back(message);
    progress.note("warning: " + message);
  };
  for (const run::PlannedScene& planned : plan.scenes)
    std::ranges::for_each(run::list_scene_warnings(planned.options, planned.scene), warn);
  std::map<std::filesystem::path, std::pair<const run::PlannedTask*, Json>> scenes;
  for (const run::PlannedTask& each : plan.tasks) {
    const run::PlannedScene& planned = plan.scenes[each.scene];
    options::RunOptions named = planned.options;
    named.map_sizes.resize(1);
    named.fits.resize(1);
    const std::filesystem::path folder = options.out / run::task_stem(named, each.task);
    if (!scenes.contains(folder)) {
      scenes[folder] = {&each, describe_view(planned, *each.task.camera)};
      exported.folders.push_back(folder);
    }
    measure::SceneAssets assets(renderer, planned.options, planned.scene, cache,
                                measure::padding_texels(planned.options));
    scenes[folder].second["maps"].push_back(
        describe_map(planned, each.task.map_size, assets.light_map(*each.task.camera, each.task.map_size).layers));
  }
  for (const auto& [folder, scene] : scenes) {
    const run::PlannedScene& planned = plan.scenes[scene.first->scene];
    write_exported_scene(folder, planned, *scene.first->task.camera, scene.second);
  }
  return exported;
}

}  // namespace shadowbench::engines
