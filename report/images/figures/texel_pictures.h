#pragma once

#include <filesystem>
#include <string>

#include "report/images/image.h"

namespace shadowbench::images {

/// How many map texels fall on each pixel, to be looked at.
struct DensityPicture {
  std::string title;
  std::string note;
  Image density;  ///< texels per pixel, one channel; 0: turned away from the light or outside the map, -1: background
};

/// Draws texels per pixel as colours on a logarithmic scale, 1/64 to 64, with a colour bar; display values.
/// Throws Error(kOutput) where the font is not installed.
Image draw_density_picture(const DensityPicture& picture);

/// Writes it as PNG. Throws Error(kOutput).
void write_density_picture(const std::filesystem::path& path, const DensityPicture& picture);

/// The map's texels as they lie on the surfaces, to be looked at.
struct TexelGridPicture {
  std::string title;
  std::string note;
  Image picture;  ///< linear RGB
  Image texel;    ///< place in the map in texels, two channels
  Image density;  ///< as DensityPicture
};

/// Chooses how many texels a side of a chessboard's field has: the smallest power of two, 1 or more, for which the
/// median field of a receiver covers 36 pixels; 1 where no receiver faces the light.
int choose_field_texels(const Image& density);

/// Draws the texels as a chessboard whose dark fields darken the picture, each of choose_field_texels() a side, which
/// the note says. Where fields are smaller than 4 pixels the pattern fades, and it is gone where they are smaller than
/// 2: it would show the pixels' grid instead. Display values. Throws Error(kOutput) where the font is not installed.
Image draw_texel_grid_picture(const TexelGridPicture& picture);

/// Writes it as PNG. Throws Error(kOutput).
void write_texel_grid_picture(const std::filesystem::path& path, const TexelGridPicture& picture);

}  // namespace shadowbench::images
