#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <map>
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

}  // namespace shadowbench::scene
