#include "report/images/figures/figure.h"

#include <algorithm>
#include <cassert>

namespace shadowbench::images {
namespace {

constexpr Font kTitle{24, true};
constexpr Font kText{17, false};

}  // namespace

std::vector<std::string> wrap_figure_text(const std::string& text, int width) { return wrap_text(text, kText, width); }

int figure_line_height() { return line_height(kText); }

Figure::Figure(const std::string& title, const std::string& note, Size body) {
  const std::vector<std::string> titles = wrap_text(title, kTitle, body.width),
                                 notes = wrap_text(note, kText, body.width);
  const int title_height = static_cast<int>(titles.size()) * line_height(kTitle);
  const int note_height = static_cast<int>(notes.size()) * line_height(kText);
  const int top = kMargin + title_height + note_height + kMargin / 2;
  body_ = {kMargin, top, body.width, body.height};
  canvas_ = Image(body.width + 2 * kMargin, top + body.height + kMargin, 3);
  std::fill(canvas_.texels.begin(), canvas_.texels.end(), 1.0f);
  int y = kMargin;
  for (const std::string& line : titles) {
    draw_text(canvas_, kMargin, y, line, kTitle, kFigureInk);
    y += line_height(kTitle);
  }
  for (const std::string& line : notes) {
    write(kMargin, y, line);
    y += line_height(kText);
  }
}

void Figure::fill(const Rect& rect, const Rgb& color) {
  for (int y = std::max(0, rect.y); y < std::min(canvas_.height, rect.y + rect.height); ++y)
    for (int x = std::max(0, rect.x); x < std::min(canvas_.width, rect.x + rect.width); ++x)
      std::copy(color.begin(), color.end(), canvas_.at(x, y));
}

void Figure::place(int x, int y, const Image& picture) {
  assert(picture.channels == 3 && x >= 0 && y >= 0 && x + picture.width <= canvas_.width &&
         y + picture.height <= canvas_.height);
  for (int row = 0; row < picture.height; ++row) {
    const float* from = picture.at(0, row);
    std::copy(from, from + 3 * picture.width, canvas_.at(x, y + row));
  }
}

void Figure::write(int x, int top, const std::string& text, Rgb color) {
  draw_text(canvas_, x, top, text, kText, color);
}

void Figure::write_centred(int x, int top, const std::string& text, Rgb color) {
  write(x - measure_text(text, kText) / 2, top, text, color);
}

void Figure::write_before(int x, int top, const std::string& text, Rgb color) {
  write(x - measure_text(text, kText), top, text, color);
}

}  // namespace shadowbench::images
