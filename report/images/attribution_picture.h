#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "report/images/image.h"
#include "report/records/error_parts.h"

namespace shadowbench::images {

/// A cell's error and the four parts it is the sum of, for people.
struct AttributionPicture {
  std::string title;     ///< "vsm on stack: where the error comes from"
  std::string subtitle;  ///< "view main · map 1024 x 1024 d32f"
  Image total;           ///< 1 channel, signed: visibility less area truth
  std::string total_caption;
  std::array<Image, metrics::kErrorParts> parts;           ///< as `total`, its size, in the order of list_error_parts()
  std::array<std::string, metrics::kErrorParts> captions;  ///< one per part, see caption_part()
  std::optional<double> scale = std::nullopt;  ///< the error that gets the full colour; chosen where not given
};

/// How large a part is: "RMS 0.0123, share 71 %"; a value that does not exist is left out.
std::string caption_part(const records::AttributionPart& part);

/// How large an error is: "RMSE 0.0173, mean signed -0.0012"; a value that does not exist is left out.
std::string caption_total(const records::ErrorRecord& error);

/// Draws the error and its parts as five heat maps on one scale, with one colour bar. Returns display-referred sRGB
/// values in [0,1], 3 channels. Throws Error(kOutput) where the font is not installed.
Image draw_attribution_picture(const AttributionPicture& picture);

/// Draws the error and its parts into an 8-bit PNG file.
/// Throws Error(kOutput).
void write_attribution_picture(const std::filesystem::path& path, const AttributionPicture& picture);

}  // namespace shadowbench::images
