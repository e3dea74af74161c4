#include "report/images/figure.h"

#include <algorithm>
#include <cmath>

#include "report/images/picture_io.h"

namespace shadowbench::images {
namespace {

constexpr int kMargin = 28, kColumnGap = 20, kRowGap = 10, kBlockGap = 24;
constexpr int kLeastWidth = 640, kLeastColumn = 320;  // words need room
constexpr int kTickLength = 6;
constexpr Font kTitle{32, true}, kHead{24, true}, kText{20, false};
constexpr int kBand = 256;  // rows

int measure_height(const std::string& text, Font font, int width) {
  return static_cast<int>(wrap_text(text, font, width).size()) * line_height(font);
}

/// What stands above a cell's picture.
int measure_head(const Cell& cell, int width) {
  return measure_height(cell.title, kHead, width) + measure_height(cell.words, kText, width) +
         measure_height(cell.warning, kText, width);
}

int widen(int width, const Stack& stack) {
  for (const Cell& cell : stack) width = std::max(width, cell.picture.width);
  return width;
}

class Builder {
 public:
  explicit Builder(const Figure& figure)
      : figure_(figure), columns_(std::clamp(static_cast<int>(figure.stacks.size()), 1, std::max(1, figure.columns))) {
    for (const Stack& stack : figure.stacks) column_ = widen(column_, stack);
    width_ = widen(std::max(kLeastWidth, columns_ * column_ + (columns_ - 1) * kColumnGap), figure.legend);
  }

  Layout build() {
    int y = add_text(figure_.title, kTitle, kInk, {kMargin, kMargin, width_, 0});
    y = add_text(figure_.note, kText, kSecondInk, {kMargin, y, width_, 0}) + kBlockGap;
    const auto step = static_cast<std::size_t>(columns_);
    for (std::size_t first = 0; first < figure_.stacks.size(); first += step)
      y = add_block(first, std::min(first + step, figure_.stacks.size()), y) + kBlockGap;
    for (const Cell& cell : figure_.legend)
      y = add_cell(cell, {kMargin, y, width_, 0}, measure_head(cell, width_)) + kRowGap;
    layout_.canvas = {width_ + 2 * kMargin, y + kMargin};
    return std::move(layout_);
  }

 private:
  /// Adds lines from the top of `column` down; returns where they end.
  int add_text(const std::string& text, Font font, const Rgb& ink, const Rect& column) {
    int y = column.y;
    for (std::string& line : wrap_text(text, font, column.width)) {
      layout_.texts.push_back({{column.x, y, column.width, line_height(font)}, std::move(line), font, ink});
      y += line_height(font);
    }
    return y;
  }

  /// Adds stacks side by side; the pictures of cells in one row begin at one height.
  int add_block(std::size_t begin, std::size_t end, int y) {
    std::size_t rows = 0;
    for (std::size_t i = begin; i < end; ++i) rows = std::max(rows, figure_.stacks[i].size());
    for (std::size_t row = 0; row < rows; ++row) {
      int head = 0, bottom = y;
      for (std::size_t i = begin; i < end; ++i)
        if (row < figure_.stacks[i].size()) head = std::max(head, measure_head(figure_.stacks[i][row], column_));
      for (std::size_t i = begin; i < end; ++i) {
        const int x = kMargin + static_cast<int>(i - begin) * (column_ + kColumnGap);
        if (row < figure_.stacks[i].size())
          bottom = std::max(bottom, add_cell(figure_.stacks[i][row], {x, y, column_, 0}, head));
      }
      y = bottom > y ? bottom + kRowGap : y;
    }
    return y;
  }

  /// Adds a cell whose picture begins `head` pixels below the top of `column`; returns where it ends.
  int add_cell(const Cell& cell, const Rect& column, int head) {
    int y = add_text(cell.title, kHead, kInk, column);
    y = add_text(cell.words, kText, kSecondInk, {column.x, y, column.width, 0});
    add_text(cell.warning, kText, kWarningInk, {column.x, y, column.width, 0});
    if (cell.picture.empty()) return column.y + head;
    const Rect box{column.x, column.y + head + (head > 0 ? kRowGap / 2 : 1), cell.picture.width, cell.picture.height};
    layout_.pictures.push_back({box, &cell.picture});
    return cell.below.empty() ? box.y + box.height + 1 : add_ticks_below(cell, box, column);
  }

  int add_ticks_below(const Cell& cell, const Rect& box, const Rect& column) {
    const int under = box.y + box.height + 1, top = under + kTickLength;
    int end = column.x;
    for (const Tick& tick : cell.below) {
      const int x = box.x + static_cast<int>(std::lround(tick.place * (box.width - 1)));
      const int width = measure_text(tick.label, kText);
      const int left = std::clamp(x - width / 2, column.x, std::max(column.x, column.x + column.width - width));
      layout_.marks.push_back({{x, under, 1, kTickLength}, kSecondInk});
      if (left < end) continue;
      layout_.texts.push_back({{left, top, width, line_height(kText)}, tick.label, kText, kSecondInk});
      end = left + width + kTickLength;
    }
    return top + line_height(kText);
  }

  const Figure& figure_;
  int columns_;
  int column_ = kLeastColumn;  ///< pixels
  int width_ = 0;              ///< of all columns
  Layout layout_;
};

}  // namespace

Layout layout_figure(const Figure& figure) { return Builder(figure).build(); }

Image draw_rows(const Layout& layout, int top, int rows) {
  Image canvas(layout.canvas.width, rows, 3);
  std::ranges::fill(canvas.texels, 1.0f);
  const auto lift = [&](Rect box) { return Rect{box.x, box.y - top, box.width, box.height}; };
  for (const PlacedPicture& placed : layout.pictures) {
    const Rect box = lift(placed.box);
    outline_rect(canvas, box, placed.frame_width, placed.frame);
    if (box.y >= rows || box.y + box.height <= 0) continue;
    const bool is_scaled = placed.picture->width != box.width || placed.picture->height != box.height;
    paste_image(canvas, is_scaled ? scale_image(*placed.picture, {box.width, box.height}) : *placed.picture, box.x,
                box.y);
  }
  for (const PlacedRect& mark : layout.marks) fill_rect(canvas, lift(mark.box), mark.ink);
  for (const PlacedText& text : layout.texts)
    if (const Rect box = lift(text.box); box.y < rows && box.y + 2 * box.height > 0)  // letters may reach below it
      draw_text(canvas, box.x, box.y, text.text, text.font, text.ink);
  return canvas;
}

void write_layout(const std::filesystem::path& path, const Layout& layout) {
  write_display_rows(
      path, layout.canvas,
      [&](int top) { return draw_rows(layout, top, std::min(kBand, layout.canvas.height - top)); });
}

void write_figure(const std::filesystem::path& path, const Figure& figure) {
  write_layout(path, layout_figure(figure));
}

}  // namespace shadowbench::images
