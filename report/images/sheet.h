#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/images/figure.h"

namespace shadowbench::images {

/// Filters on one sheet; with the truth and the view it has ten places.
inline constexpr std::size_t kFiltersOfSheet = 8;

/// The part of an image that a sheet magnifies, four times where the sheet is 1920 pixels wide.
inline constexpr Size kSheetCrop{88, 66};

/// One place of a sheet. Images are display values.
struct SheetTile {
  std::string name;
  std::string number = {};                   ///< its error; empty where there is none
  std::optional<double> bar = std::nullopt;  ///< the error over the largest one
  std::string words = {};                    ///< its cost
  std::string role = {};                     ///< bold, after the words
  std::string message = {};                  ///< what is wrong with it, or why there is no crop
  Image crop = {};
  Image inset = {};  ///< the same pixels, small, over the crop's corner
};

/// The filters of one scene beside the truth, for a slide or a paper.
struct Sheet {
  std::string title;
  std::string note;
  SheetTile truth;
  std::vector<SheetTile> filters;  ///< at most kFiltersOfSheet, in the order that is shown
  Image view;                      ///< the whole image; empty where there is none
  Rect crop;                       ///< the part of it that is magnified
  std::vector<std::string> view_notes = {};
  int inset_column = 1, inset_row = 1;  ///< the corner of insets: 0 left or above, 1 right or below
};

/// Places everything: truth, filters, and the view with the crop's outline, which begins the second row, or ends the
/// only one. The result points into `sheet`. Throws Error(kOutput) where the font is not installed.
Layout layout_sheet(const Sheet& sheet, SheetWidth width = {});

/// Draws a sheet into a PNG file of at most 1920x1080 pixels, or as wide and in proportion; or into an SVG file.
/// Throws Error(kOutput).
void write_sheet(const std::filesystem::path& path, const Sheet& sheet, SheetWidth width = {});

}  // namespace shadowbench::images
