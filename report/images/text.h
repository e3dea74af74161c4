#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "report/images/canvas.h"

namespace shadowbench::images {

/// DejaVu Sans in one size; pixels per em.
struct Font {
  int size = 20;
  bool bold = false;
};

/// The file of the font that is not bold. Throws Error(kOutput) where it is not installed.
std::filesystem::path font_file();

/// Returns UTF-8 fit for drawing: every run of white space or control characters becomes one space, every byte that is
/// not UTF-8 becomes U+FFFD; no space at either end.
std::string clean_text(std::string_view text);

/// Returns the width of one line of clean text, in pixels.
/// Throws Error(kOutput) where the font is not installed.
int measure_text(const std::string& text, Font font);

/// Returns the distance from one line to the next, in pixels.
int line_height(Font font);

/// Splits a text into lines no wider than `width` pixels, at spaces, and inside a word only where the word alone is too
/// wide. Requires room for one character. Returns no line for an empty text.
std::vector<std::string> wrap_text(std::string_view text, Font font, int width);

/// Draws one line of clean text, its box's left top corner at (x, top).
/// Requires a canvas of 3 channels. Throws Error(kOutput) where the font is not installed.
void draw_text(Image& canvas, int x, int top, const std::string& text, Font font, Rgb color);

}  // namespace shadowbench::images
