#pragma once

#include <map>
#include <optional>
#include <string>

#include "report/images/image.h"

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

}  // namespace shadowbench::engines
