#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/toml.h"
#include "reference/truth/area_light.h"

namespace shadowbench::scene {

struct FitRequest;
struct FitRule;
struct LightFrustum;
struct MapWindow;
struct Scene;
struct Texture;

/// The cone that a lamp in the scene lights.
struct Beam {
  glm::dvec3 position_ws{0.0};
  glm::dvec3 axis_ws{0.0, -1.0, 0.0};  ///< the way the light travels, unit length
  double cos_inner = 1.0;              ///< full strength within this angle of the axis
  double cos_outer = 0.0;              ///< none beyond this one
  double reference_m = 1.0;            ///< where its strength is 1

  /// Whether there is a direction that gets no light.
  bool has_edge() const { return cos_outer > -1.0; }
  /// The share of the cone's light that goes to a point, 0 .. 1: the square of a ramp between both angles, of cosines.
  /// Source: Khronos, KHR_lights_punctual, "Inner and Outer Cone Angles". 0 for the light's own place.
  double cone_at(const glm::dvec3& point_ws) const;
};

/// A part of a linear colour.
inline constexpr Range kColor{0.0, 1.0};

/// Maps unit vectors.
using LightTurn = std::function<glm::vec3(const glm::vec3&)>;

/// What a picture's metadata say of a light, by name.
using LightMetadata = std::map<std::string, std::variant<double, std::string>>;

/// What a number of a light is. It tells the unit that a picture's metadata write behind its name, and the order of the
/// window's sliders: sizes, angles, places.
enum class NumberRole { kDirection, kPlace, kSize, kReach, kAngle };

/// A number of a light, or those of a vector. Scene files, metadata, names of cells and sliders say what the list of
/// its kind has.
struct LightNumber {
  std::string key;  ///< in a scene file: "cone_deg"
  NumberRole role;
  std::span<float> values;        ///< of the light that was asked
  std::optional<Range> slider{};  ///< what it may be set to; a place may be anything
  bool is_used = true;            ///< else the light has another in its place, a size for a radius
};

/// Refuses the keys of a [light] that neither all lights have nor one of this kind.
void require_light_keys(const TomlTable& table, const std::vector<std::string>& own);

/// A place of a scene as its file has it, relative to the scene's origin.
toml::array write_place(const glm::vec3& place_ws, const glm::dvec3& origin);

/// "1 2 3", for texts that name a light.
std::string write_vector(const glm::vec3& v);

/// A sphere in the scene that shines all around.
struct PointLight {
  glm::vec3 position_ws{0.0f, 1.0f, 0.0f};
  float radius_m = 0.05f;    ///< of the sphere; 0: a point
  float reference_m = 1.0f;  ///< where its light is as strong as a sun's
};

/// The point light that a scene file describes. Throws kInput.
PointLight read_point(const TomlTable& table);

/// What light.h asks of every kind.
glm::vec3 to_light(const PointLight& point, const glm::vec3& point_ws);
std::optional<Beam> find_beam(const PointLight& point);  ///< without an edge; its axis says nothing
double light_size(const PointLight& point);
truth::AreaLight make_area_light(const PointLight& point);
void turn_light(PointLight& point, const LightTurn& turn);
void aim_light(PointLight& point, const glm::vec3& center_ws);
PointLight checked_light(const PointLight& point, const std::string& where);
std::string describe_light(const PointLight& point);
std::vector<LightNumber> list_numbers(PointLight& point);
int count_layers(const PointLight& point, const MapWindow* window, const FitRule& rule);
std::vector<LightFrustum> fit_layers(const PointLight& point, const MapWindow* window, const Scene& scene,
                                     const FitRequest& request);

/// A lamp that stands in the scene: a disk or a rectangle that faces its target, whose light fills a cone with a soft
/// edge.
struct Spot {
  glm::vec3 position_ws{0.0f, 1.0f, 0.0f};
  glm::vec3 target_ws{0.0f};     ///< the cone's axis leads there, and its light is as strong there as a sun's
  float cone_deg = 60.0f;        ///< from edge to edge; no light beyond
  float inner_cone_deg = 45.0f;  ///< the same, full strength within
  float radius_m = 0.05f;        ///< of the disk; 0: a point
  glm::vec2 size_m{0.0f};        ///< sides of a rectangle in place of the disk, along the map's u and v; 0: the disk
};

/// A cone must be narrower than a half-space: its map is drawn through one perspective.
inline constexpr float kWidestCone_deg = 170.0f;

/// The spot that a scene file describes. Throws kInput.
Spot read_spot(const TomlTable& table);

/// What light.h asks of every kind.
glm::vec3 to_light(const Spot& spot, const glm::vec3& point_ws);
std::optional<Beam> find_beam(const Spot& spot);
double light_size(const Spot& spot);
truth::AreaLight make_area_light(const Spot& spot);
void turn_light(Spot& spot, const LightTurn& turn);
void aim_light(Spot& spot, const glm::vec3& center_ws);
Spot checked_light(const Spot& spot, const std::string& where);
std::string describe_light(const Spot& spot);
std::vector<LightNumber> list_numbers(Spot& spot);
int count_layers(const Spot& spot, const MapWindow* window, const FitRule& rule);
std::vector<LightFrustum> fit_layers(const Spot& spot, const MapWindow* window, const Scene& scene,
                                     const FitRequest& request);

/// A directional light: a disk at infinity.
struct Sun {
  glm::vec3 direction_ws{0.0f, -1.0f, 0.0f};  ///< the way the light travels, unit length
  float angular_diameter_deg = 0.53f;         ///< seen from the scene; 0: a point at infinity
};

/// A place in the sky, or where something is seen from: azimuth 0 is +z, 90 is +x; degrees.
struct SkyAngles {
  double azimuth_deg = 0.0;
  double elevation_deg = 0.0;
};

/// The way light travels that comes from a place in the sky, see SkyAngles.
glm::dvec3 light_direction(double azimuth_deg, double elevation_deg);

/// The sun that a scene file describes, but for its map window. Throws kInput.
Sun read_sun(const TomlTable& table);

/// An orthographic frustum over these receivers, in world space, with the casters between them and the light; without
/// any, over the whole scene.
LightFrustum fit_sun_over(const Sun& sun, const Scene& scene, const FitRequest& request,
                          const std::vector<glm::dvec3>& receivers);

/// What light.h asks of every kind.
glm::vec3 to_light(const Sun& sun, const glm::vec3& point_ws);
std::optional<Beam> find_beam(const Sun& sun);
double light_size(const Sun& sun);
truth::AreaLight make_area_light(const Sun& sun);
void turn_light(Sun& sun, const LightTurn& turn);
void aim_light(Sun& sun, const glm::vec3& center_ws);
Sun checked_light(const Sun& sun, const std::string& where);
std::string describe_light(const Sun& sun);
std::vector<LightNumber> list_numbers(Sun& sun);
int count_layers(const Sun& sun, const MapWindow* window, const FitRule& rule);
std::vector<LightFrustum> fit_layers(const Sun& sun, const MapWindow* window, const Scene& scene,
                                     const FitRequest& request);

}  // namespace shadowbench::scene
