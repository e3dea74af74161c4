#include "report/grid_layout.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/diverging.h"

namespace shadowbench::report {
namespace {

constexpr int kMargin = 28;
constexpr int kTileWidth = 468;  // three of them make a grid of 1500 pixels
constexpr int kColumnGap = 20;
constexpr int kRowGap = 10;
constexpr int kBlockGap = 34;
constexpr int kMessagePadding = 16;
constexpr int kMaxPictureHeight = 560;
constexpr int kMaxCropHeight = 260;
constexpr int kColorBarWidth = 240;

// Height of each row of a block, shared by its tiles so that they line up.
struct BlockRows {
  int text = 0;
  int picture = 0;
  int visibility = 0;
  int error = 0;
  int crop = 0;

  int images_height() const {
    int height = 0;
    for (const int row : {picture, visibility, error, crop}) {
      height += row > 0 ? row + kRowGap : 0;
    }
    return std::max(0, height - kRowGap);
  }
};

class Builder {
 public:
  explicit Builder(const Grid& grid) : grid_(grid) {
    const int columns = std::clamp(static_cast<int>(grid.tiles.size()), 1, std::max(1, grid.columns));
    columns_ = static_cast<std::size_t>(columns);
    layout_.canvas.width = 2 * kMargin + columns * kTileWidth + (columns - 1) * kColumnGap;
  }

  GridLayout build() {
    int y = kMargin;
    y = add_text(grid_.title, TextRole::kTitle, full_width(y));
    y = add_text(grid_.subtitle, TextRole::kSubtitle, full_width(y + 4)) + kBlockGap / 2;
    for (std::size_t first = 0; first < grid_.tiles.size(); first += columns_) {
      y = add_block(first, std::min(first + columns_, grid_.tiles.size()), y) + kBlockGap;
    }
    y = add_color_bar(y);
    y = add_text(legend(), TextRole::kLegend, full_width(y));
    layout_.canvas.height = y + kMargin;
    return std::move(layout_);
  }

 private:
  Rect full_width(int y) const { return {kMargin, y, layout_.canvas.width - 2 * kMargin, 0}; }

  int text_height(const std::string& text, TextRole role, int width) const {
    return static_cast<int>(wrap_text(text, font_of(role), width).size()) * line_height(font_of(role));
  }

  // Adds lines from the top of `column` down; returns where they end.
  int add_text(const std::string& text, TextRole role, const Rect& column) {
    int y = column.y;
    for (std::string& line : wrap_text(text, font_of(role), column.width)) {
      layout_.texts.push_back({{column.x, y, column.width, line_height(font_of(role))}, std::move(line), role});
      y += line_height(font_of(role));
    }
    return y;
  }

  BlockRows measure_rows(std::size_t begin, std::size_t end) const {
    BlockRows rows;
    for (std::size_t i = begin; i < end; ++i) {
      const GridTile& tile = grid_.tiles[i];
      rows.text = std::max(rows.text, text_height(tile.label, TextRole::kLabel, kTileWidth) +
                                          text_height(tile.caption, TextRole::kCaption, kTileWidth));
      rows.picture = std::max(rows.picture, shown_size(tile.picture).height);
      rows.visibility = std::max(rows.visibility, shown_size(tile.visibility).height);
      rows.error = std::max(rows.error, shown_size(tile.error).height);
      for (const Image* image : {&tile.picture, &tile.visibility}) {
        rows.crop = std::max(rows.crop, crop_size(*image).height);
      }
    }
    return rows;
  }

  static Size shown_size(const Image& image) {
    return fit_size({image.width, image.height}, {kTileWidth, kMaxPictureHeight});
  }

  Size crop_size(const Image& image) const {
    const Rect crop = clip_crop(grid_.crop, image);
    return fit_size({crop.width, crop.height}, {(kTileWidth - kRowGap) / 2, kMaxCropHeight});
  }

  int add_block(std::size_t begin, std::size_t end, int y) {
    const BlockRows rows = measure_rows(begin, end);
    const int images_y = y + rows.text + kRowGap;
    int bottom = images_y + rows.images_height();
    for (std::size_t i = begin; i < end; ++i) {
      const GridTile& tile = grid_.tiles[i];
      const int x = kMargin + static_cast<int>(i - begin) * (kTileWidth + kColumnGap);
      const int caption_y = add_text(tile.label, TextRole::kLabel, {x, y, kTileWidth, 0});
      add_text(tile.caption, TextRole::kCaption, {x, caption_y, kTileWidth, 0});
      if (tile.picture.empty() && tile.visibility.empty()) {
        bottom = std::max(bottom, add_message(tile, {x, images_y, kTileWidth, rows.images_height()}));
      } else {
        add_panels(i, {x, images_y, kTileWidth, 0}, rows);
      }
    }
    return bottom;
  }

  /// One scale for the whole grid, with its bar and what its ends mean.
  int add_color_bar(int y) {
    std::vector<const Image*> errors;
    for (const GridTile& tile : grid_.tiles) {
      if (!tile.error.empty()) errors.push_back(&tile.error);
    }
    if (errors.empty()) return y;
    layout_.error_scale = choose_error_scale(errors);
    const int height = line_height(font_of(TextRole::kLegend));
    layout_.color_bar = Rect{kMargin, y, kColorBarWidth, height};
    const std::string text = fmt::format("error, visibility less area truth: -{0} (too dark, blue) to +{0} (too bright, red)",
                                         layout_.error_scale);
    const int x = kMargin + kColorBarWidth + kColumnGap;
    return std::max(add_text(text, TextRole::kLegend, {x, y, layout_.canvas.width - kMargin - x, 0}), y + height) + kRowGap;
  }

  int add_message(const GridTile& tile, const Rect& place) {
    const int width = place.width - 2 * kMessagePadding;
    const int needed = text_height(tile.message, TextRole::kMessage, width) + 2 * kMessagePadding;
    layout_.message_boxes.push_back({place.x, place.y, place.width, std::max(place.height, needed)});
    add_text(tile.message, TextRole::kMessage, {place.x + kMessagePadding, place.y + kMessagePadding, width, 0});
    return place.y + std::max(place.height, needed);
  }

  void add_panels(std::size_t index, const Rect& column, const BlockRows& rows) {
    const GridTile& tile = grid_.tiles[index];
    int y = column.y;
    add_panel({column.x, y, column.width, rows.picture}, shown_size(tile.picture), index, PanelKind::kPicture);
    y += rows.picture > 0 ? rows.picture + kRowGap : 0;
    add_panel({column.x, y, column.width, rows.visibility}, shown_size(tile.visibility), index, PanelKind::kVisibility);
    y += rows.visibility > 0 ? rows.visibility + kRowGap : 0;
    add_panel({column.x, y, column.width, rows.error}, shown_size(tile.error), index, PanelKind::kError);
    y += rows.error > 0 ? rows.error + kRowGap : 0;
    const int half = (column.width - kRowGap) / 2;
    add_panel({column.x, y, half, rows.crop}, crop_size(tile.picture), index, PanelKind::kPictureCrop);
    add_panel({column.x + column.width - half, y, half, rows.crop}, crop_size(tile.visibility), index,
              PanelKind::kVisibilityCrop);
  }

  // Places an image in the middle of its row.
  void add_panel(const Rect& row, Size size, std::size_t tile, PanelKind kind) {
    if (size.width > 0) {
      layout_.panels.push_back(
          {{row.x + (row.width - size.width) / 2, row.y + (row.height - size.height) / 2, size.width, size.height},
           tile,
           kind});
    }
  }

  std::string legend() const {
    if (layout_.panels.empty()) {
      return {};
    }
    std::string text = "Top: shaded picture. Below it: visibility (white lit, black blocked)";
    text += layout_.color_bar ? ", then its error." : ".";
    for (const Panel& panel : layout_.panels) {
      if (panel.kind == PanelKind::kVisibilityCrop || panel.kind == PanelKind::kPictureCrop) {
        const int factor = panel.box.width / std::max(1, grid_.crop.width);
        return text + " Bottom: the outlined part of both" +
               (factor > 1 ? fmt::format(", {} times larger.", factor) : ".");
      }
    }
    return text;
  }

  const Grid& grid_;
  std::size_t columns_ = 1;
  GridLayout layout_;
};

}  // namespace

Font font_of(TextRole role) {
  switch (role) {
    case TextRole::kTitle:
      return {34, true};
    case TextRole::kLabel:
      return {28, true};
    case TextRole::kSubtitle:
    case TextRole::kCaption:
    case TextRole::kMessage:
    case TextRole::kLegend:
      break;
  }
  return {21, false};
}

Size fit_size(Size size, Size box) {
  if (size.width <= 0 || size.height <= 0) {
    return {};
  }
  const int factor = std::min(box.width / size.width, box.height / size.height);
  if (factor >= 1) {
    return {size.width * factor, size.height * factor};
  }
  const double scale =
      std::min(static_cast<double>(box.width) / size.width, static_cast<double>(box.height) / size.height);
  return {std::clamp(static_cast<int>(size.width * scale + 0.5), 1, box.width),
          std::clamp(static_cast<int>(size.height * scale + 0.5), 1, box.height)};
}

Rect clip_crop(const Rect& crop, const Image& image) {
  const int left = std::clamp(crop.x, 0, image.width);
  const int top = std::clamp(crop.y, 0, image.height);
  const int right = std::clamp(crop.x + crop.width, left, image.width);
  const int bottom = std::clamp(crop.y + crop.height, top, image.height);
  return {left, top, right - left, bottom - top};
}

GridLayout layout_grid(const Grid& grid) { return Builder(grid).build(); }

}  // namespace shadowbench::report
