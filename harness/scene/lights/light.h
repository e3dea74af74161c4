#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/toml.h"
#include "reference/truth/area_light.h"

namespace shadowbench::scene {

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

/// "1 2 3", for texts that name a light.
std::string write_vector(const glm::vec3& v);

/// A sphere in the scene that shines all around.
struct PointLight {
  glm::vec3 position_ws{0.0f, 1.0f, 0.0f};
  float radius_m = 0.05f;    ///< of the sphere; 0: a point
  float reference_m = 1.0f;  ///< where its light is as strong as a sun's
};

/// A lamp that stands in the scene: a disk or a rectangle that faces its target, whose light fills a cone with a soft
/// edge.
struct Spot {
  glm::vec3 position_ws{0.0f, 1.0f, 0.0f};
  glm::vec3 target_ws{0.0f};     ///< the cone's axis leads there, and its light is as strong there as a sun's
  float cone_deg = 60.0f;        ///< from edge to edge; no light beyond
  float inner_cone_deg = 45.0f;  ///< the same, full strength within
  float radius_m = 0.05f;        ///< of the disk; 0: a point
  glm::vec2 size_m{0.0f};        ///< sides of a rectangle in place of the disk, along the map's u and v; 0: the disk

  bool is_rectangle() const;
};

/// A cone must be narrower than a half-space: its map is drawn through one perspective.
inline constexpr float kWidestCone_deg = 170.0f;

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

/// The kinds of light. What differs between them has a case for each in light.cpp; the compiler names what is missing.
using LightKind = std::variant<Sun, Spot, PointLight>;

/// A light's map that is not fitted to the scene: it may leave receivers outside.
struct MapWindow {
  /// Planes across the light's direction, metres from the centre along it; negative is before the centre.
  struct Planes {
    double near_m = 0.0;  ///< depth 0; what lies before it casts nothing
    double far_m = 0.0;   ///< depth 1
  };

  glm::dvec3 center_ws{0.0};
  double width_m = 0.0;          ///< side of the square map
  std::optional<Planes> planes;  ///< none: fitted to the scene
};

struct Light {
  std::string name;  ///< of one of several; else empty
  LightKind kind;
  glm::vec3 color{1.0f};  ///< linear
  float intensity = 1.0f;
  std::optional<MapWindow> map_window;  ///< none: the map is fitted to the scene
};

/// The direction from a point to the light's centre, unit length.
glm::vec3 to_light(const Light& light, const glm::vec3& point_ws);

/// The cone of a light that stands in the scene; nothing for one at infinity.
std::optional<Beam> find_beam(const Light& light);

/// Whether any of the light goes to a point.
bool shines_on(const Light& light, const glm::vec3& point_ws);

/// The light's size: of one at infinity the width of a penumbra for each metre between a receiver and its occluder, of
/// one in the scene its diameter in metres, of a rectangle that of the disk of its area.
double light_size(const Light& light);

/// The width of the penumbra that an occluder throws which is so many metres before a receiver, across the light's way;
/// of a light in the scene as it would be at the distance that its map's texels are told for.
double penumbra_width(const Light& light, const glm::vec3& receiver_ws, double occluder_m);

/// The light as the truth traces it.
truth::AreaLight make_area_light(const Light& light);

/// The light with its direction mapped by `turn`; one in the scene goes round its target, or the world's origin.
Light turn_light(Light light, const LightTurn& turn);

/// Turns a light about the vertical.
Light turn_about_vertical(const Light& light, double angle_rad);

/// The light moved to a place in the sky; one in the scene as seen from what it goes round.
Light place_in_sky(Light light, const SkyAngles& place);

/// Reads the [light] of a scene file, relative to the scene's origin. Throws kInput.
Light read_light(const TomlTable& table, const glm::dvec3& origin = glm::dvec3(0.0));

/// A number of a light that may be changed by hand.
struct LightSlider {
  std::string name;  ///< "size u", "position x"
  std::string unit;
  float* value = nullptr;      ///< of the light that was asked
  std::optional<Range> range;  ///< none: any number
};

/// The numbers of a light beside its direction: its size first.
std::vector<LightSlider> list_sliders(Light& light);

/// A place of a scene as its file has it, relative to the scene's origin.
toml::array write_place(const glm::vec3& place_ws, const glm::dvec3& origin);

/// What the [light] of a scene file says of it. Reads back with the same origin.
toml::table write_light(Light light, const glm::dvec3& origin = glm::dvec3(0.0));

/// Returns the light of a glTF node, or nothing for a type that is not modelled. A spot's cones are given as half
/// angles, radians; glTF knows no size of lamps, so that it gets that of one without `radius` in a scene file.
std::optional<LightKind> make_gltf_light(std::string_view type, const glm::dmat4& world_from_node,
                                         double inner_cone_rad = 0.0, double outer_cone_rad = 0.0);

/// A light as glTF has it. The place of a sun is the origin, and a point light looks down.
struct GltfLight {
  std::string type;  ///< of KHR_lights_punctual
  glm::dvec3 position_ws{0.0};
  glm::dvec3 direction_ws{0.0, -1.0, 0.0};  ///< the way the light travels, unit length
  double inner_cone_rad = 0.0;              ///< half angles, of a spot
  double outer_cone_rad = 0.0;
};
GltfLight describe_gltf_light(const Light& light);

/// What glTF has no word for of a light, by the keys of a scene file; and a light of a glTF file with it.
/// Throws kInput, with `where`, for a key or value that a scene file does not take.
toml::table list_gltf_extras(const Light& light);
Light with_gltf_extras(const Light& light, const toml::table& extras, const std::string& where,
                       const glm::dvec3& origin = glm::dvec3(0.0));

/// A light in the scene whose light is as strong as a sun's where `center_ws` is, or as far ahead; others stay as they
/// are. A glTF file says where a spot looks, and not how far.
Light aim_light(Light light, const glm::vec3& center_ws);

/// Throws kInput, with `where`, for a light that is not finite or has no direction.
Light checked_light(Light light, const std::string& where);

/// The light in words, for the caption of a picture: "a sun of 0.53 degrees".
std::string describe_light(const Light& light);

/// What a picture's metadata say of the light.
LightMetadata light_metadata(Light light);

/// All that a result depends on, as text for the name of a cell.
std::vector<std::string> list_light_content(Light light);

}  // namespace shadowbench::scene
