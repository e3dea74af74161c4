#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/scene/lights/light.h"
#include "reference/truth/occluders.h"

namespace shadowbench::scene {

/// One corner of a triangle, in world space; metres.
struct Vertex {
  glm::vec3 position_ws{0.0f};
  glm::vec3 normal_ws{0.0f, 1.0f, 0.0f};  ///< shading normal, unit length
  glm::vec2 uv{0.0f};                     ///< v = 0 is the texture's first row, as in glTF
};

/// An 8-bit sRGB picture with alpha, rows top to bottom.
struct Texture {
  std::string name;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
};

enum class AlphaMode {
  kOpaque,
  kMask,   ///< holes where alpha is below the cutoff
  kBlend,  ///< alpha is the share of the light that is held back; a camera sees it opaque
};

struct Material {
  std::string name;
  glm::vec4 base_color{0.8f, 0.8f, 0.8f, 1.0f};  ///< linear
  int base_color_texture = -1;                   ///< index into Scene::textures, -1: none
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
};

/// Triangles that share a material; node transforms are already applied.
struct Mesh {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle, all < vertices.size()
  int material = 0;                    ///< index into Scene::materials
  bool casts_shadow = true;            ///< drawn into the shadow map
  bool may_cull_front = true;          ///< with front-face culling: only its back faces are drawn into the shadow map
};

/// A place to look from. Perspective, unless `orthographic_height_m` is positive.
struct Camera {
  std::string name = "main";
  glm::vec3 position_ws{0.0f};
  glm::vec3 forward_ws{0.0f, 0.0f, -1.0f};  ///< unit length
  glm::vec3 up_ws{0.0f, 1.0f, 0.0f};        ///< unit length, not parallel to forward_ws
  float vertical_fov_rad = 0.8f;
  float orthographic_height_m = 0.0f;  ///< full height of the view; 0: perspective
  std::string light;                   ///< the one of several lights that is seen from here; empty: all
};

/// An axis-aligned box; empty while min > max.
struct Bounds {
  glm::vec3 min{1.0f};
  glm::vec3 max{-1.0f};
  bool empty() const { return min.x > max.x; }
  void add(const glm::vec3& p);
};

/// A level rectangle that was put under a bare model.
struct Floor {
  glm::vec2 size_m{0.0f};  ///< along x, z
  glm::vec3 center_ws{0.0f};
};

/// Everything a run needs to know of a scene; checked: finite, not empty, indices in range.
struct Scene {
  std::string name;   ///< file stem; names report files
  std::string title;  ///< for people
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Camera> cameras;  ///< at least one
  Light light;
  std::vector<Light> other_lights;            ///< see separate_lights()
  glm::dvec3 origin_ws{0.0};                  ///< where its file has what is (0,0,0) here: see find_way_off()
  double rounding_m = 0.0;                    ///< of positions, as models' files have them
  std::optional<Floor> floor;                 ///< of the last mesh, where that was put under a bare model
  glm::vec3 background{0.62f, 0.71f, 0.82f};  ///< linear
  std::vector<std::string> warnings;          ///< what was changed or ignored while loading, for the user
  std::vector<std::string> notes;             ///< what was chosen while loading, for the user

  Bounds bounds() const;
  std::size_t triangle_count() const;
};

/// How far a scene lies off: zero, unless its origin is many times its size away, where single precision would be spent
/// on the distance; then a round place near its middle, which is to be its origin. Of bounds that were rounded that far
/// off it is not the last word: what is read again from there may lie off by less.
glm::dvec3 find_way_off(const Bounds& bounds);

/// A copy of a scene for each of its lights, which alone shines there, with the cameras for that light; called
/// SCENE.LIGHT where there are several.
std::vector<Scene> separate_lights(const Scene& scene);

/// The name of such a scene without its light's.
std::string name_without_light(const Scene& scene);

/// What rays can hit of a scene: every mesh that casts a shadow, with the holes or the transparency of its material;
/// or, without `casts_shadow`, the other meshes.
std::vector<truth::OccluderMesh> list_occluders(const Scene& scene, bool casts_shadow = true);

/// No coordinate may be larger.
inline constexpr float kFarthest_m = 1e12f;

/// Checks that a scene can be rendered and measured, and repairs what has one sensible repair.
///
/// Throws kInput, at `where`, for: no triangles, an index out of range, a coordinate or normal that is not finite or
/// lies beyond 1e12 m, a light without direction, a camera without direction or with an impossible view. Drops
/// triangles without area and vertices that no triangle uses, replaces zero normals by the face's, and normalises
/// directions. Changes that are seen in the picture are noted in `warnings`.
Scene validate(Scene scene, const std::string& where);

/// The part of `validate` that concerns meshes and materials; code that frames or measures a scene relies on it.
Scene validate_geometry(Scene scene, const std::string& where);

/// The part of `validate` that concerns one camera.
Camera checked_camera(Camera camera, const std::string& where);

/// Whether a direction has unit length, but for the rounding of its floats. It then stays as it is: what was read,
/// written and read again is the same.
bool is_unit(const glm::dvec3& v);

/// Returns `v` with unit length. Throws kInput, naming `owner`, where it has no direction.
glm::vec3 unit_direction(const glm::vec3& v, const std::string& owner, const std::string& where);

}  // namespace shadowbench::scene
