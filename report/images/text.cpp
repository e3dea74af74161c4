#include "report/images/text.h"

#include <algorithm>
#include <cassert>
#include <nlohmann/json.hpp>

#include "report/images/font_face.h"

namespace shadowbench::images {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

bool is_space(char c) { return static_cast<unsigned char>(c) <= ' ' || c == '\x7f'; }

// Horizontal extent of a line from its pen position; a first letter may reach left of it.
struct Extent {
  int begin = 0;
  int end = 0;
};

Extent measure_extent(const std::string& text, Font font) {
  Extent extent;
  const int pen = visit_glyphs(text, font, [&](const GlyphBitmap& glyph) {
    extent.begin = std::min(extent.begin, glyph.box.x);
    extent.end = std::max(extent.end, glyph.box.x + glyph.box.width);
  });
  extent.end = std::max(extent.end, pen);
  return extent;
}

// Where a path or an identifier may end a line better than in the middle of a word.
std::size_t find_good_break(const std::string& piece) {
  const std::size_t found = piece.find_last_of("/_-,=:");
  return found != std::string::npos && found >= piece.size() / 3 ? found + 1 : piece.size();
}

void blend_glyph(Image& canvas, int x, int y, const GlyphBitmap& glyph, const Rgb& color) {
  for (int row = 0; row < glyph.box.height; ++row) {
    for (int column = 0; column < glyph.box.width; ++column) {
      const int px = x + glyph.box.x + column;
      const int py = y + glyph.box.y + row;
      if (px < 0 || py < 0 || px >= canvas.width || py >= canvas.height) continue;
      const float cover = static_cast<float>(glyph.coverage[row * glyph.stride + column]) / 255.0f;
      for (std::size_t c = 0; c < 3; ++c) {
        float& value = canvas.at(px, py)[c];
        value += cover * (color[c] - value);
      }
    }
  }
}

std::vector<std::string> split_words(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

// The longest beginning of a word that fits; at least one character.
std::string fitting_beginning(const std::string& word, Font font, int width) {
  std::string fit;
  for (std::size_t begin = 0; begin < word.size();) {
    std::size_t end = begin + 1;
    while (end < word.size() && is_continuation(word[end])) ++end;
    if (!fit.empty() && measure_text(word.substr(0, end), font) > width) break;
    fit = word.substr(0, end);
    begin = end;
  }
  return fit;
}

// Words, those too wide for a line cut into pieces that are not.
std::vector<std::string> split_fitting_words(const std::string& text, Font font, int width) {
  std::vector<std::string> pieces;
  for (std::string word : split_words(text)) {
    while (measure_text(word, font) > width) {
      std::string piece = fitting_beginning(word, font, width);
      if (piece == word) break;  // a single character wider than the line
      piece.resize(find_good_break(piece));
      pieces.push_back(piece);
      word.erase(0, piece.size());
    }
    pieces.push_back(word);
  }
  return pieces;
}

}  // namespace

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
  for (const std::string& word : split_fitting_words(clean_text(text), font, width))
    if (!lines.empty() && measure_text(lines.back() + " " + word, font) <= width)
      lines.back() += " " + word;
    else
      lines.push_back(word);
  return lines;
}

void draw_text(Image& canvas, int x, int top, const std::string& text, Font font, Rgb color) {
  assert(canvas.channels == 3);
  const int pen = x - measure_extent(text, font).begin;
  visit_glyphs(text, font, [&](const GlyphBitmap& glyph) { blend_glyph(canvas, pen, top + font.size, glyph, color); });
}

}  // namespace shadowbench::images
