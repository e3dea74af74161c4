#include "report/images/font_face.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <array>
#include <cassert>
#include <filesystem>
#include <memory>
#include <type_traits>

#include "filters/base/error.h"

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

}  // namespace

int visit_glyphs(const std::string& text, Font font, const std::function<void(const GlyphBitmap&)>& visit) {
  FT_Face face = face_of(font);
  int pen = 0;
  for (const char32_t point : decode_utf8(text)) {
    if (FT_Load_Char(face, point, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) continue;
    const FT_GlyphSlot glyph = face->glyph;
    const FT_Bitmap& bitmap = glyph->bitmap;
    visit(
        {{pen + glyph->bitmap_left, -glyph->bitmap_top, static_cast<int>(bitmap.width), static_cast<int>(bitmap.rows)},
         bitmap.buffer,
         bitmap.pitch});
    pen += static_cast<int>((glyph->advance.x + 32) >> 6);
  }
  return pen;
}

std::filesystem::path font_file() { return find_font(kPlainFont); }

}  // namespace shadowbench::images
