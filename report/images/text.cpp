#include "report/images/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "base/error.h"

namespace shadowbench::images {
namespace {

constexpr std::array kFontFolders{"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts",
                                  "/usr/share/fonts/dejavu", "/usr/share/fonts/TTF", "/usr/local/share/fonts"};

struct CloseLibrary {
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
};
struct CloseFace {
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};
using Library = std::unique_ptr<std::remove_pointer_t<FT_Library>, CloseLibrary>;
using Face = std::unique_ptr<std::remove_pointer_t<FT_Face>, CloseFace>;

Library open_library() {
  FT_Library library = nullptr;
  FT_Init_FreeType(&library);
  return Library(library);
}

constexpr const char* kPlainFont = "DejaVuSans.ttf";

[[noreturn]] void refuse_font(const std::string& name) {
  throw Error(
      ErrorKind::kOutput,
      "the font " + name + " is not installed, so no labels can be drawn; install the package fonts-dejavu-core");
}

std::filesystem::path find_font(const std::string& name) {
  for (const char* folder : kFontFolders)
    if (std::filesystem::exists(std::filesystem::path(folder) / name)) return std::filesystem::path(folder) / name;
  refuse_font(name);
}

Face open_face(FT_Library library, const std::string& name) {
  FT_Face face = nullptr;
  if (FT_New_Face(library, find_font(name).c_str(), 0, &face) == 0) return Face(face);
  refuse_font(name);
}

// FreeType's faces belong to one thread each.
FT_Face face_of(Font font) {
  thread_local const Library library = open_library();
  thread_local const Face plain = open_face(library.get(), kPlainFont);
  thread_local const Face bold = open_face(library.get(), "DejaVuSans-Bold.ttf");
  FT_Face face = font.bold ? bold.get() : plain.get();
  FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(font.size));
  return face;
}

// OpenImageIO 2.4 would draw text too, but its UTF-8 decoder loses all bits of a character but the last six.
std::u32string decode_utf8(const std::string& text) {
  std::u32string points;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U && !points.empty()) {
      points.back() = (points.back() << 6U) | (byte & 0x3FU);
    } else {
      const unsigned mask = byte < 0x80U ? 0x7FU : byte < 0xE0U ? 0x1FU : byte < 0xF0U ? 0x0FU : 0x07U;
      points += static_cast<char32_t>(byte & mask);
    }
  }
  return points;
}

/// Calls `visit` for every glyph of a line of clean text with its left top corner, relative to the pen's start on the
/// baseline, y down. Returns where the pen ends, in pixels.
int visit_glyphs(const std::string& text, Font font, const std::function<void(int, int, const FT_Bitmap&)>& visit) {
  FT_Face face = face_of(font);
  int pen = 0;
  for (const char32_t point : decode_utf8(text)) {
    if (FT_Load_Char(face, point, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) continue;
    const FT_GlyphSlot glyph = face->glyph;
    visit(pen + glyph->bitmap_left, -glyph->bitmap_top, glyph->bitmap);
    pen += static_cast<int>((glyph->advance.x + 32) >> 6);
  }
  return pen;
}

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

bool is_space(char c) { return static_cast<unsigned char>(c) <= ' ' || c == '\x7f'; }

// Horizontal extent of a line from its pen position; a first letter may reach left of it.
struct Extent {
  int begin = 0;
  int end = 0;
};

Extent measure_extent(const std::string& text, Font font) {
  Extent extent;
  const int pen = visit_glyphs(text, font, [&](int x, int, const FT_Bitmap& glyph) {
    extent.begin = std::min(extent.begin, x);
    extent.end = std::max(extent.end, x + static_cast<int>(glyph.width));
  });
  extent.end = std::max(extent.end, pen);
  return extent;
}

// Where a path or an identifier may end a line better than in the middle of a word.
std::size_t find_good_break(const std::string& piece) {
  const std::size_t found = piece.find_last_of("/_-,=:");
  return found != std::string::npos && found >= piece.size() / 3 ? found + 1 : piece.size();
}

/// Blends a glyph over a canvas, its left top corner at (x, y).
void blend_glyph(Image& canvas, int x, int y, const FT_Bitmap& glyph, const Rgb& color) {
  for (int row = 0; row < static_cast<int>(glyph.rows); ++row) {
    for (int column = 0; column < static_cast<int>(glyph.width); ++column) {
      const int px = x + column, py = y + row;
      if (px < 0 || py < 0 || px >= canvas.width || py >= canvas.height) continue;
      const float cover = static_cast<float>(glyph.buffer[row * glyph.pitch + column]) / 255.0f;
      for (std::size_t c = 0; c < 3; ++c) {
        float& value = canvas.at(px, py)[c];
        value += cover * (color[c] - value);
      }
    }
  }
}

// The longest beginning of a text that fits; at least one character.
std::string fitting_beginning(const std::string& text, Font font, int width) {
  std::vector<std::size_t> ends;
  for (std::size_t end = 1; end <= text.size(); ++end)
    if (end == text.size() || !is_continuation(text[end])) ends.push_back(end);
  const auto fits = [&](std::size_t end) { return measure_text(text.substr(0, end), font) <= width; };
  return text.substr(0, *(std::partition_point(ends.begin() + 1, ends.end(), fits) - 1));
}

// The first line of a text that is wider than a line.
std::string first_line(const std::string& text, Font font, int width) {
  const std::string fit = fitting_beginning(text, font, width);
  std::size_t space = text.rfind(' ', fit.size());
  if (space != std::string::npos && text.compare(space, 2, " %") == 0) space = text.rfind(' ', space - 1);
  return fit.substr(0, space != std::string::npos ? space : find_good_break(fit));
}

}  // namespace

std::filesystem::path font_file() { return find_font(kPlainFont); }

std::string clean_text(std::string_view text) {
  using nlohmann::json;
  const std::string quoted = json(std::string(text)).dump(-1, ' ', false, json::error_handler_t::replace);
  std::string clean;
  for (const char c : json::parse(quoted).get<std::string>())
    if (!is_space(c))
      clean += c;
    else if (!clean.empty() && clean.back() != ' ')
      clean += ' ';
  if (!clean.empty() && clean.back() == ' ') clean.pop_back();
  return clean;
}

int measure_text(const std::string& text, Font font) {
  const Extent extent = measure_extent(text, font);
  return extent.end - extent.begin;
}

int line_height(Font font) { return (font.size * 13 + 9) / 10; }

std::vector<std::string> wrap_text(std::string_view text, Font font, int width) {
  std::vector<std::string> lines;
  std::string rest = clean_text(text);
  while (measure_text(rest, font) > width) {
    lines.push_back(first_line(rest, font, width));
    rest.erase(0, lines.back().size() + (rest[lines.back().size()] == ' ' ? 1 : 0));
  }
  if (!rest.empty()) lines.push_back(rest);
  return lines;
}

void draw_text(Image& canvas, int x, int top, const std::string& text, Font font, Rgb color) {
  assert(canvas.channels == 3);
  const int pen = x - measure_extent(text, font).begin;
  visit_glyphs(text, font, [&](int left, int above, const FT_Bitmap& glyph) {
    blend_glyph(canvas, pen + left, top + font.size + above, glyph, color);
  });
}

}  // namespace shadowbench::images
