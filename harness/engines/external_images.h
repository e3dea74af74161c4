#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reference/truth/visibility.h"
#include "report/images/image.h"
#include "report/records/records.h"

namespace shadowbench::engines {

/// The files of another renderer, as a user names them: FILE, or FILE#PART.
struct ExternalFiles {
  std::string layers;  ///< one file with layers of the four names below; empty: none
  std::string lit = {};
  std::string unlit = {};
  std::string visibility = {};
  std::string depth = {};
  std::string unbiased = {};
  std::string shadow_map = {};  ///< its own, of any size
};

/// What another renderer drew of a view; rows top to bottom, linear values, one channel each.
struct ExternalImages {
  std::optional<images::Image> lit;         ///< the light with its shadow, mean of the channels
  std::optional<images::Image> unlit;       ///< the same without the shadow
  std::optional<images::Image> visibility;  ///< 1 lit .. 0 blocked
  std::optional<images::Image> depth;       ///< metres along the camera's axis; 0 or not finite where nothing is
  std::string names;                        ///< of the files, for messages
  std::optional<images::Image> unbiased;    ///< visibility as it is without any bias: what of a gap its filter makes
  std::optional<images::Image> shadow_map;  ///< as it is stored; rows from v = 1 down
};

/// Reads them. Throws Error(kInput): a file that cannot be read, a layer that is missing (lit comes with unlit, or
/// there is a visibility), codes that are sRGB, sizes that differ from each other.
ExternalImages read_external_images(const ExternalFiles& files);

/// What a meta.json says of a row.
struct Meta {
  records::ExternalRecord external;
  std::string truth;                         ///< of the scene.json that was drawn; empty where it is not said
  std::optional<glm::dmat4> map_from_world;  ///< of the shadow map; see OwnMap
};

/// Throws Error(kInput) for what is no object of texts and numbers, or has another key than README.md lists.
Meta read_meta(const std::filesystem::path& file);

/// A shadow map of another renderer.
struct OwnMap {
  images::Image depth;             ///< one channel, as it is stored; the first row is v = 1
  glm::dmat4 map_from_world{1.0};  ///< to (u, v, depth, 1) times w; in the map u and v are 0 .. 1
};

/// Looks every receiver that counts up in the texel that it falls into, with the least bias that keeps planes free of
/// acne: half a texel's change of depth along the receiver's plane, along u and along v. 1 lit, 0 in shadow; beyond the
/// map all is lit. Whether depth grows away from the light is found from the matrix: `to_light_ws` leads to it.
/// What differs from a ray to the light's centre is then the map's doing: its texels, its precision, and what was drawn
/// into it.
std::vector<double> look_up(const OwnMap& map, const truth::ReceiverImage& receivers,
                            const std::vector<glm::vec3>& to_light_ws);

}  // namespace shadowbench::engines
