#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "filters/base/toml.h"
#include "harness/scene/lights/beam.h"
#include "reference/truth/area_light.h"

namespace shadowbench::scene {

struct FitRequest;
struct FitRule;
struct LightFrustum;
struct MapWindow;
struct Scene;
struct Texture;

/// A part of a linear colour.
inline constexpr Range kColor{0.0, 1.0};

/// Maps unit vectors.
using LightTurn = std::function<glm::vec3(const glm::vec3&)>;

/// What a picture's metadata say of a light, by name.
using LightMetadata = std::map<std::string, std::variant<double, std::string>>;

/// A number of a light that may be changed.
struct LightNumber {
  std::string name;
  std::string unit;
  float* value = nullptr;  ///< of the light that was asked
  float min = 0.0f;
  float max = 0.0f;  ///< less than `min`: any number
};

/// The coordinates of a place, each any number.
std::vector<LightNumber> list_coordinates(const std::string& name, glm::vec3& place_ws);

/// What a table of a scene file says, by key.
using TomlEntries = std::map<std::string, std::variant<double, std::string, std::vector<double>>>;

/// Numbers for a scene file: the shortest decimals that are read back as the same floats.
double write_number(float value);
std::vector<double> write_numbers(const glm::vec3& v);

/// "1 2 3", for texts that name a light.
std::string write_vector(const glm::vec3& v);

}  // namespace shadowbench::scene
