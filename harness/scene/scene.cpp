#include "harness/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "base/error.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

truth::CutOut make_cut_out(const Scene& scene, const Mesh& mesh, const Material& material) {
  truth::CutOut cut_out;
  for (const Vertex& vertex : mesh.vertices) cut_out.uvs.push_back(vertex.uv);
  cut_out.base_alpha = material.base_color.a;
  cut_out.cutoff = material.alpha_cutoff;
  cut_out.dims = material.alpha_mode == AlphaMode::kBlend;
  if (material.base_color_texture < 0) return cut_out;
  const Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
  cut_out.width = texture.width;
  cut_out.height = texture.height;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) cut_out.alpha.push_back(texture.rgba[i]);
  return cut_out;
}

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string text_of(const glm::vec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

void check_vertices(const Mesh& mesh, const std::string& where) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vertex& vertex = mesh.vertices[i];
    const auto complain = [&](const char* what, const glm::vec3& value) {
      fail_input(fmt::format("vertex {} of mesh '{}' has the {} {}", i, mesh.name, what, text_of(value)), where);
    };
    if (!is_finite(vertex.position_ws)) complain("not finite position", vertex.position_ws);
    if (!is_finite(vertex.normal_ws)) complain("not finite normal", vertex.normal_ws);
    if (!std::isfinite(vertex.uv.x) || !std::isfinite(vertex.uv.y))
      complain("not finite texture coordinate", glm::vec3(vertex.uv, 0.0f));
    const glm::vec3 size = glm::abs(vertex.position_ws);
    if (std::max({size.x, size.y, size.z}) > kFarthest_m) complain("too distant position", vertex.position_ws);
  }
}

void check_indices(const Mesh& mesh, const Scene& scene, const std::string& where) {
  if (mesh.indices.size() % 3 != 0)
    fail_input(fmt::format("mesh '{}' has {} indices, which is no multiple of 3", mesh.name, mesh.indices.size()),
               where);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (mesh.indices[i] < mesh.vertices.size()) continue;
    fail_input(fmt::format("index {} of mesh '{}' is {}, but there are {} vertices", i, mesh.name, mesh.indices[i],
                           mesh.vertices.size()),
               where);
  }
  if (mesh.material < 0 || static_cast<std::size_t>(mesh.material) >= scene.materials.size())
    fail_input(fmt::format("mesh '{}' has material {} of {}", mesh.name, mesh.material, scene.materials.size()), where);
}

/// Whether a triangle's area is zero but for the rounding of the cross product.
bool has_no_area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  constexpr double kRounding = 1e-12;
  const double edge = std::max({glm::length(glm::dvec3(b) - glm::dvec3(a)), glm::length(glm::dvec3(c) - glm::dvec3(b)),
                                glm::length(glm::dvec3(a) - glm::dvec3(c))});
  return !(glm::length(area_normal(a, b, c)) > kRounding * edge * edge);
}

/// Keeps the triangles that have an area.
Mesh without_degenerate_triangles(Mesh mesh) {
  std::vector<std::uint32_t> kept;
  kept.reserve(mesh.indices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i];
    const std::uint32_t b = mesh.indices[i + 1];
    const std::uint32_t c = mesh.indices[i + 2];
    if (has_no_area(mesh.vertices[a].position_ws, mesh.vertices[b].position_ws, mesh.vertices[c].position_ws)) continue;
    kept.insert(kept.end(), {a, b, c});
  }
  mesh.indices = std::move(kept);
  return mesh;
}

/// Makes all normals unit length; those without one get that of a face they belong to.
Mesh with_unit_normals(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    glm::vec3& normal = mesh.vertices[mesh.indices[i]].normal_ws;
    glm::dvec3 direction(normal);
    if (glm::length(direction) == 0.0) {
      const std::size_t first = i - i % 3;
      direction = area_normal(mesh.vertices[mesh.indices[first]].position_ws,
                              mesh.vertices[mesh.indices[first + 1]].position_ws,
                              mesh.vertices[mesh.indices[first + 2]].position_ws);
    }
    normal = glm::vec3(glm::normalize(direction));
  }
  return mesh;
}

/// A direction across the view: the given one made perpendicular, unless it is, or, if that is parallel to the view,
/// the axis least parallel to it.
glm::vec3 usable_up(const glm::vec3& up, const glm::vec3& forward) {
  constexpr double kLeastSine = 1e-4, kRightAngle = 1e-6;
  const glm::dvec3 ahead(forward);
  const auto across = [&](const glm::dvec3& v) { return v - glm::dot(v, ahead) * ahead; };
  const glm::dvec3 given(up);
  if (is_unit(given) && std::abs(glm::dot(given, ahead)) < kRightAngle) return up;
  const bool usable = is_finite(up) && glm::length(across(given)) > kLeastSine * glm::length(given);
  return glm::vec3(glm::normalize(across(usable ? given : axis_least_parallel(ahead))));
}

/// Renames cameras or lights of equal name, since names tell their pictures apart.
void make_names_unique(const std::vector<std::string*>& names) {
  std::set<std::string> taken;
  std::map<std::string, int> last_number;  // without it, equal names take time with their number squared
  for (std::string* each : names) {
    const std::string name = *each;
    int& number = last_number.try_emplace(name, 1).first->second;
    while (!taken.insert(*each).second) *each = fmt::format("{} {}", name, ++number);
  }
}

void name_lights(Scene& scene) {
  if (scene.other_lights.empty()) return;
  std::vector<std::string*> names = {&scene.light.name};
  for (Light& light : scene.other_lights) names.push_back(&light.name);
  for (std::string* name : names)
    if (name->empty()) *name = "light";
  make_names_unique(names);
}

void check_material(const Material& material, const Scene& scene, const std::string& where) {
  if (material.base_color_texture >= static_cast<int>(scene.textures.size())) {
    fail_input(fmt::format("material '{}' has texture {} of {}", material.name, material.base_color_texture,
                           scene.textures.size()),
               where);
  }
  const float alpha = material.base_color.a;
  if (material.alpha_mode == AlphaMode::kBlend && !(alpha >= 0.0f && alpha <= 1.0f)) {
    fail_input(
        fmt::format("material '{}' blends with an alpha of {}; it must lie between 0 and 1", material.name, alpha),
        where);
  }
  const bool finite = is_finite(glm::vec3(material.base_color)) && std::isfinite(material.base_color.a) &&
                      std::isfinite(material.alpha_cutoff);
  if (!finite) fail_input(fmt::format("material '{}' has a colour that is not finite", material.name), where);
}

}  // namespace

void Bounds::add(const glm::vec3& p) {
  const bool first = empty();
  min = first ? p : glm::min(min, p);
  max = first ? p : glm::max(max, p);
}

Bounds Scene::bounds() const {
  Bounds box;
  for (const Mesh& mesh : meshes)
    for (const Vertex& vertex : mesh.vertices) box.add(vertex.position_ws);
  return box;
}

glm::dvec3 find_way_off(const Bounds& bounds) {
  constexpr double kFar = 4.0, kLeastSize = 1e-6;  // of the scene's size, and of the distance
  const glm::dvec3 min(bounds.min), max(bounds.max), middle = 0.5 * (min + max);
  const double distance = glm::length(middle), size = std::max(glm::length(max - min), kLeastSize * distance);
  if (!(distance <= double{kFarthest_m} && distance > kFar * size)) return glm::dvec3(0.0);
  const double step = std::exp2(std::floor(std::log2(size)));
  return step * glm::round(middle / step);
}

std::size_t Scene::triangle_count() const {
  std::size_t count = 0;
  for (const Mesh& mesh : meshes) count += mesh.indices.size() / 3;
  return count;
}

std::vector<Scene> separate_lights(const Scene& scene) {
  if (scene.other_lights.empty()) return {scene};
  std::vector<Light> lights = scene.other_lights;
  lights.insert(lights.begin(), scene.light);
  std::vector<Scene> scenes;
  for (Light& light : lights) {
    Scene& lit = scenes.emplace_back(scene);
    lit.other_lights.clear();
    lit.name += "." + light.name;
    lit.title += ": " + light.name;
    lit.light = std::move(light);
    std::erase_if(lit.cameras, [&](const Camera& each) { return !each.light.empty() && each.light != lit.light.name; });
  }
  return scenes;
}

std::string name_without_light(const Scene& scene) {
  const std::string end = "." + scene.light.name;
  const bool is_separate = !scene.light.name.empty() && scene.name.ends_with(end);
  return is_separate ? scene.name.substr(0, scene.name.size() - end.size()) : scene.name;
}

std::vector<truth::OccluderMesh> list_occluders(const Scene& scene, bool casts_shadow) {
  std::vector<truth::OccluderMesh> meshes;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.casts_shadow != casts_shadow) continue;
    truth::OccluderMesh& surface = meshes.emplace_back();
    for (const Vertex& vertex : mesh.vertices) surface.positions.push_back(vertex.position_ws);
    surface.indices = mesh.indices;
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (material.alpha_mode != AlphaMode::kOpaque) surface.cut_out = make_cut_out(scene, mesh, material);
  }
  return meshes;
}

bool is_unit(const glm::dvec3& v) {
  return std::abs(glm::length(v) - 1.0) < double{std::numeric_limits<float>::epsilon()};
}

glm::vec3 unit_direction(const glm::vec3& v, const std::string& owner, const std::string& where) {
  const glm::dvec3 direction(v);
  const double length = glm::length(direction);
  if (!std::isfinite(length) || !(length > 0.0))
    fail_input(fmt::format("{} has no direction: {}", owner, text_of(v)), where);
  return is_unit(direction) ? v : glm::vec3(direction / length);
}

Camera checked_camera(Camera camera, const std::string& where) {
  const std::string owner = fmt::format("camera '{}'", camera.name);
  if (!is_finite(camera.position_ws)) fail_input(owner + " stands at " + text_of(camera.position_ws), where);
  camera.forward_ws = unit_direction(camera.forward_ws, owner, where);
  camera.up_ws = usable_up(camera.up_ws, camera.forward_ws);
  const bool orthographic = camera.orthographic_height_m != 0.0f;
  const float fov = camera.vertical_fov_rad;
  if (orthographic && !(std::isfinite(camera.orthographic_height_m) && camera.orthographic_height_m > 0.0f))
    fail_input(fmt::format("{} sees a height of {} m", owner, camera.orthographic_height_m), where);
  if (!orthographic && !(fov > 0.0f && fov < std::numbers::pi_v<float>))
    fail_input(fmt::format("{} has a vertical field of view of {} rad; it must lie between 0 and pi", owner, fov),
               where);
  return camera;
}

Scene validate_geometry(Scene scene, const std::string& where) {
  const std::size_t given = scene.triangle_count();
  for (const Material& material : scene.materials) check_material(material, scene, where);
  for (Mesh& mesh : scene.meshes) {
    check_indices(mesh, scene, where);
    check_vertices(mesh, where);
    mesh = with_unit_normals(without_unused_vertices(without_degenerate_triangles(std::move(mesh))));
  }
  std::erase_if(scene.meshes, [](const Mesh& mesh) { return mesh.indices.empty(); });
  const std::size_t dropped = given - scene.triangle_count();
  if (given == 0) fail_input("the scene is empty: it has no triangles", where);
  if (dropped == given) fail_input(fmt::format("none of its {} triangles has an area", given), where);
  if (dropped > 0)
    scene.warnings.push_back(fmt::format("{} of {} triangles without area were dropped", dropped, given));
  return scene;
}

Scene validate(Scene scene, const std::string& where) {
  scene.light = checked_light(scene.light, where);
  for (Light& light : scene.other_lights) light = checked_light(light, where);
  scene = validate_geometry(std::move(scene), where);
  for (Camera& camera : scene.cameras) camera = checked_camera(camera, where);
  std::vector<std::string*> names;
  for (Camera& camera : scene.cameras) names.push_back(&camera.name);
  make_names_unique(names);
  name_lights(scene);
  return scene;
}

}  // namespace shadowbench::scene
