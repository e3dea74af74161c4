#include "report/images/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "report/images/picture_io.h"
#include "report/images/value_file.h"

namespace shadowbench::images {
namespace {

constexpr Rgb kAccent{0.87f, 0.37f, 0.14f}, kBarInk{0.33f, 0.33f, 0.34f}, kTrackInk{0.92f, 0.92f, 0.92f};
constexpr Rgb kPaper{1.0f, 1.0f, 1.0f};
constexpr double kLeastTile = 9.4, kMostTile = 16.0;  // in sizes of the text
constexpr int kMostColumns = 5, kMostNameLines = 6;
constexpr int kTextOfScreen = 22, kLeastText = 12;
constexpr double kScreen = 1920.0, kPointsOfInch = 72.0, kPointsOfText = 8.0;

/// The units of a layout that an inch has: text of 8 points is as large as on a screen.
constexpr double kUnitsOfInch = kPointsOfInch / kPointsOfText * kTextOfScreen;

/// The size of an image that fills a width, by a whole factor where that is close, and is no higher than wide.
Size fill_width(const Image& image, int width) {
  double factor = static_cast<double>(width) / std::max(image.width, image.height);
  if (factor >= 1.0 && factor - std::floor(factor) < 0.05 * factor) factor = std::floor(factor);
  const auto scale = [&](int side) { return std::max(1, static_cast<int>(std::lround(side * factor))); };
  return {scale(image.width), scale(image.height)};
}

class SheetBuilder {
 public:
  SheetBuilder(const Sheet& sheet, SheetWidth width)
      : sheet_(sheet),
        most_(static_cast<int>(std::lround(width.in_inches ? width.value * kUnitsOfInch : width.value))),
        text_{width.in_inches ? kTextOfScreen
                              : std::max(kLeastText, static_cast<int>(std::lround(most_ * kTextOfScreen / kScreen)))},
        margin_(width.in_inches ? em(0.1) : em(1.6)) {
    places_.push_back(&sheet.truth);
    for (const SheetTile& tile : sheet.filters) places_.push_back(&tile);
    const int count = static_cast<int>(places_.size()) + (sheet.view.empty() ? 0 : 1);
    const int inner = most_ - 2 * margin_;
    const int fit = std::clamp((inner + gap_) / (em(kLeastTile) + gap_), 1, kMostColumns);
    const int rows = (count + fit - 1) / fit;
    columns_ = (count + rows - 1) / rows;
    tile_ = (inner - (columns_ - 1) * gap_) / columns_;
    if (!width.in_inches) tile_ = std::min(tile_, em(kMostTile));
    width_ = columns_ * tile_ + (columns_ - 1) * gap_;
    if (!sheet.view.empty())  // null stands for the view
      places_.insert(places_.begin() + (rows > 1 ? columns_ : static_cast<int>(places_.size())), nullptr);
  }

  Layout build() {
    int y = add_text(sheet_.title, {em(1.5), true}, kInk, {margin_, margin_, width_, 0});
    y = add_text(sheet_.note, text_, kSecondInk, {margin_, y, width_, 0}) + em(0.6);
    const auto step = static_cast<std::size_t>(columns_);
    for (std::size_t first = 0; first < places_.size(); first += step)
      y = add_row(first, std::min(first + step, places_.size()), y) + em(0.9);
    layout_.canvas = {width_ + 2 * margin_, y - em(0.9) + margin_};
    return std::move(layout_);
  }

 private:
  /// So many sizes of the text, pixels.
  int em(double sizes) const { return static_cast<int>(std::lround(sizes * text_.size)); }

  int add_text(const std::string& text, Font font, const Rgb& ink, const Rect& column) {
    return add_lines(wrap_text(text, font, column.width), font, ink, column);
  }

  int add_lines(const std::vector<std::string>& lines, Font font, const Rgb& ink, const Rect& column) {
    int y = column.y;
    for (const std::string& line : lines) {
      layout_.texts.push_back({{column.x, y, column.width, line_height(font)}, line, font, ink});
      y += line_height(font);
    }
    return y;
  }

  /// A name's lines; the last has room for the number.
  std::vector<std::string> wrap_name(const SheetTile& tile) const {
    std::vector<std::string> lines = shorten(wrap_text(tile.name, name_, tile_), kMostNameLines);
    const int number = tile.number.empty() ? 0 : measure_text(tile.number, name_) + em(0.4);
    if (!lines.empty() && measure_text(lines.back(), name_) + number > tile_) lines.emplace_back();
    return lines;
  }

  static std::vector<std::string> shorten(std::vector<std::string> lines, int most) {
    if (lines.size() <= static_cast<std::size_t>(most)) return lines;
    lines.resize(static_cast<std::size_t>(most));
    lines.back().resize(lines.back().size() - std::min<std::size_t>(lines.back().size(), 3));
    lines.back() = clean_text(lines.back()) + "…";
    return lines;
  }

  std::string words_of(const SheetTile* tile) const {
    return tile ? tile->words : fmt::format("where the crop is ({:.3g}×)", magnification());
  }

  double magnification() const {
    for (const SheetTile* tile : places_)
      if (tile && !tile->crop.empty())
        return static_cast<double>(fill_width(tile->crop, tile_).width) / tile->crop.width;
    return 1.0;
  }

  bool has_bars() const {
    return std::ranges::any_of(
        sheet_.filters, [](const SheetTile& tile) { return tile.bar.has_value(); });
  }

  /// Whether a role stands behind the words, or below them.
  bool fits_role(const SheetTile& tile) const {
    return measure_text(tile.words + " · ", text_) + measure_text(tile.role, bold_) <= tile_;
  }

  int measure_words(const SheetTile* tile) const {
    auto lines = static_cast<int>(wrap_text(words_of(tile), text_, tile_).size());
    if (tile && !tile->role.empty() && (lines != 1 || !fits_role(*tile))) ++lines;
    return lines * line_height(text_);
  }

  /// What is above the images of a row: names, bars and words, each aligned at their lower ends.
  int add_row(std::size_t begin, std::size_t end, int y) {
    int names = 0, words = 0, bottom = 0;
    const int bar = has_bars() ? em(0.8) : em(0.2);
    for (std::size_t i = begin; i < end; ++i) {
      if (places_[i]) names = std::max(names, static_cast<int>(wrap_name(*places_[i]).size()) * line_height(name_));
      words = std::max(words, measure_words(places_[i]));
    }
    for (std::size_t i = begin; i < end; ++i) {
      const int x = margin_ + static_cast<int>(i - begin) * (tile_ + gap_);
      const int top = y + names + bar + words + em(0.2);
      if (places_[i]) add_name(*places_[i], x, y + names);
      add_words(places_[i], x, top - em(0.2) - measure_words(places_[i]));
      bottom = std::max(bottom, places_[i] ? add_crop(*places_[i], x, top) : add_view(x, top));
    }
    return bottom;
  }

  void add_name(const SheetTile& tile, int x, int bottom) {
    const std::vector<std::string> lines = wrap_name(tile);
    const int top = bottom - static_cast<int>(lines.size()) * line_height(name_), last = bottom - line_height(name_);
    const int number = measure_text(tile.number, name_);
    int y = top;
    for (const std::string& line : lines) {
      const int room = y == last && number > 0 ? tile_ - number - em(0.4) : tile_;
      if (!line.empty()) layout_.texts.push_back({{x, y, room, line_height(name_)}, line, name_, kInk});
      y += line_height(name_);
    }
    if (number > 0)
      layout_.texts.push_back({{x + tile_ - number, last, number, line_height(name_)}, tile.number, name_, kInk});
    if (!tile.bar) return;
    const int height = em(0.35), length = static_cast<int>(std::lround(std::clamp(*tile.bar, 0.0, 1.0) * tile_));
    layout_.marks.push_back({{x, bottom + em(0.2), tile_, height}, kTrackInk});
    layout_.marks.push_back({{x, bottom + em(0.2), length, height}, kBarInk});
  }

  void add_words(const SheetTile* tile, int x, int y) {
    const std::string words = words_of(tile);
    const bool beside = tile && !tile->role.empty() && fits_role(*tile);
    const int width = beside && !words.empty() ? measure_text(words + " · ", text_) : tile_;
    const int end = add_text(beside && !words.empty() ? words + " ·" : words, text_, kSecondInk, {x, y, width, 0});
    if (!tile || tile->role.empty()) return;
    const int left = beside && !words.empty() ? x + width : x;
    add_text(tile->role, bold_, kInk, {left, beside ? y : end, x + tile_ - left, 0});
  }

  int add_crop(const SheetTile& tile, int x, int y) {
    if (tile.crop.empty()) {
      const int most = tile_ * 3 / 4 / line_height(text_);
      return add_lines(shorten(wrap_text(tile.message, text_, tile_), most), text_, kWarningInk, {x, y, tile_, 0});
    }
    const Size size = fill_width(tile.crop, tile_);
    const Rect box{x, y, size.width, size.height};
    const bool is_truth = &tile == &sheet_.truth;
    layout_.pictures.push_back({box, &tile.crop, is_truth ? kAccent : kPaper, is_truth ? std::max(1, em(0.12)) : 0});
    if (!tile.inset.empty()) {
      const Size half{size.width / 2, size.height / 2};
      layout_.pictures.push_back({{x + sheet_.inset_column * (size.width - half.width),
                                   y + sheet_.inset_row * (size.height - half.height), half.width, half.height},
                                  &tile.inset,
                                  kPaper,
                                  std::max(1, em(0.1))});
    }
    return add_text(tile.message, text_, kWarningInk, {x, y + size.height + em(0.2), tile_, 0});
  }

  int add_view(int x, int y) {
    const Size size = fill_width(sheet_.view, tile_);
    layout_.pictures.push_back({{x, y, size.width, size.height}, &sheet_.view, kPaper, 0});
    const double scale = static_cast<double>(size.width) / sheet_.view.width;
    const auto place = [&](int at) { return static_cast<int>(std::lround(at * scale)); };
    add_outline({x + place(sheet_.crop.x), y + place(sheet_.crop.y), std::max(1, place(sheet_.crop.width)),
                 std::max(1, place(sheet_.crop.height))});
    y += size.height + em(0.3);
    for (const std::string& note : sheet_.view_notes) y = add_text(note, small_, kSecondInk, {x, y, tile_, 0});
    return y;
  }

  void add_outline(const Rect& r) {
    const int line = std::max(1, em(0.12));
    for (const Rect& side : {Rect{r.x, r.y, r.width, line}, Rect{r.x, r.y + r.height - line, r.width, line},
                             Rect{r.x, r.y, line, r.height}, Rect{r.x + r.width - line, r.y, line, r.height}})
      layout_.marks.push_back({side, kAccent});
  }

  const Sheet& sheet_;
  int most_;  ///< the whole width, at most
  Font text_;
  int margin_;
  Font bold_{text_.size, true}, name_{em(1.2), true}, small_{em(0.85), false};
  int gap_ = em(0.55);
  int columns_ = 1, tile_ = 0, width_ = 0;
  std::vector<const SheetTile*> places_;
  Layout layout_;
};

std::string describe_color(const Rgb& color) {
  const auto code = [](float value) { return static_cast<int>(std::lround(255.0f * value)); };
  return fmt::format("#{:02x}{:02x}{:02x}", code(color[0]), code(color[1]), code(color[2]));
}

std::string escape_xml(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return escaped;
}

std::string draw_rect(const Rect& box, const Rgb& color) {
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", box.x, box.y, box.width,
                     box.height, describe_color(color));
}

/// Texts are as long as they were measured, whatever font the reader has.
std::string make_svg(const Layout& layout) {
  const Size canvas = layout.canvas;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.4f}in\" height=\"{:.4f}in\" viewBox=\"0 0 {} {}\" "
      "font-family=\"DejaVu Sans, Verdana, sans-serif\">\n",
      canvas.width / kUnitsOfInch, canvas.height / kUnitsOfInch, canvas.width, canvas.height);
  svg += draw_rect({0, 0, canvas.width, canvas.height}, kPaper);
  for (const PlacedPicture& placed : layout.pictures) {
    const Rect& box = placed.box;
    const int frame = placed.frame_width;
    if (frame > 0)
      svg += draw_rect({box.x - frame, box.y - frame, box.width + 2 * frame, box.height + 2 * frame}, placed.frame);
    const bool reduced = placed.picture->width > box.width;
    const Image image = reduced ? scale_image(*placed.picture, {box.width, box.height}) : *placed.picture;
    const std::string png = encode_display_png(image);
    svg += fmt::format(
        "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
        "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
        box.x, box.y, box.width, box.height, encode_base64(png));
  }
  for (const PlacedRect& mark : layout.marks) svg += draw_rect(mark.box, mark.ink);
  for (const PlacedText& text : layout.texts)
    svg += fmt::format(
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{} fill=\"{}\" textLength=\"{}\" "
        "lengthAdjust=\"spacingAndGlyphs\">{}</text>\n",
        text.box.x, text.box.y + text.font.size, text.font.size, text.font.bold ? " font-weight=\"bold\"" : "",
        describe_color(text.ink), measure_text(text.text, text.font), escape_xml(text.text));
  return svg + "</svg>\n";
}

}  // namespace

Layout layout_sheet(const Sheet& sheet, SheetWidth width) { return SheetBuilder(sheet, width).build(); }

void write_sheet(const std::filesystem::path& path, const Sheet& sheet, SheetWidth width) {
  const Layout layout = layout_sheet(sheet, width);
  if (width.in_inches)
    write_text_file(path, make_svg(layout));
  else
    write_layout(path, layout);
}

}  // namespace shadowbench::images
