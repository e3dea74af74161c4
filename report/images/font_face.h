#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "report/images/image.h"
#include "report/images/text.h"

namespace shadowbench::images {

/// One glyph's coverage, placed relative to the pen on the baseline, y down.
struct GlyphBitmap {
  Rect box;
  const unsigned char* coverage = nullptr;  ///< rows of `stride` bytes, 255 covered
  int stride = 0;
};

/// Calls `visit` for every glyph of a line of clean text, left to right, the pen starting at 0.
/// Returns where the pen ends, in pixels. Throws Error(kOutput) where the font is not installed.
int visit_glyphs(const std::string& text, Font font, const std::function<void(const GlyphBitmap&)>& visit);

/// The file of the font that is not bold. Throws Error(kOutput) where it is not installed.
std::filesystem::path font_file();

}  // namespace shadowbench::images
