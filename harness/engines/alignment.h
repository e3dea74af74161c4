#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/engines/external_images.h"

namespace shadowbench::engines {

/// Faces that block the light's centre from a receiver that is wholly in shadow: those of them that face the light, and
/// those that face away from it, by the order of their corners.
inline constexpr std::uint8_t kFrontsCast = 1, kBacksCast = 2;

/// What we know of a view that another renderer drew; rows top to bottom.
struct OwnView {
  std::vector<std::uint8_t> counts;      ///< 1: a receiver, a surface that faces the light
  std::vector<std::uint8_t> is_surface;  ///< 0: background
  images::Image depth;                   ///< metres along the camera's axis; 0: background
  images::Image direct;  ///< what the light adds to matt surfaces where nothing is in its way: grey, in any unit
  std::vector<glm::vec3> normals_ws;     ///< of surfaces, as they are shaded
  std::optional<glm::vec3> to_light_ws;  ///< of a light at infinity, unit length
  std::vector<std::uint8_t> is_back{};   ///< 1: a surface that is seen from behind; empty: not known
  std::vector<std::uint8_t> casters{};   ///< kFrontsCast + kBacksCast, 0 but in full shadow; empty: not known
};

/// What is wrong with another renderer's pictures, or may be.
struct Finding {
  bool refuses = false;  ///< what is scored would mean nothing
  std::string text;      ///< a sentence: what, and its likely cause
};

/// Where another renderer's picture lies on ours, pixels.
struct Alignment {
  std::string by = "nothing";       ///< "depth", "coverage" or "nothing": what it was found from
  std::optional<glm::dvec2> shift;  ///< of theirs, to the right and down
  std::optional<double> p99;        ///< 99th percentile over pixels of how far apart the two are; by depth alone
};

/// The visibility that pictures of another renderer hold, and what was found out about them.
struct CheckedImages {
  images::Image visibility;  ///< NaN at receivers where it is not defined: unlit is not above 0, or something is NaN
  std::int64_t undefined = 0;
  Alignment alignment;
  std::vector<Finding> findings;
};

inline constexpr double kWarnedShift = 0.05;  ///< pixels
inline constexpr double kMostShift = 0.25;

/// Forms the visibility, lit over unlit, and checks that the pictures show our view: size, orientation, shift, light,
/// encoding. Throws Error(kInput) where nothing could be compared: another size, a picture that is black all over, no
/// receiver with a finite value.
CheckedImages check_images(const ExternalImages& images, const OwnView& own);

/// 1 for those of `which` all of whose neighbours are on the same smooth surface: where antialiasing and half a pixel
/// do not show.
std::vector<std::uint8_t> find_inside(const OwnView& own, const std::vector<std::uint8_t>& which);

/// Compares the light that another renderer's surfaces have without shadows with that of ours: values for a display in
/// place of linear light, a light from elsewhere, antialiasing, few bits.
void check_light(const ExternalImages& images, const OwnView& own, std::vector<Finding>& findings);

/// Where unlit has no more than this, an engine's rounding is all that it has.
float least_light(const images::Image& unlit);

/// The neighbour of a pixel; nothing beyond the picture's edge.
std::optional<std::size_t> step(std::size_t pixel, int dx, int dy, int width, int height);

}  // namespace shadowbench::engines
