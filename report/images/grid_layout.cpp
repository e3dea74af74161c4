#include "report/images/grid_layout.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/images/color_values.h"
#include "report/records/format.h"

namespace shadowbench::images {
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
constexpr int kBarHeight = 30;
constexpr int kSwatchGap = 8;
constexpr int kLegendGap = 28;

// Height of each row of a block, shared by its tiles so that they line up.
struct BlockRows {
  int text = 0;
  int picture = 0;
  int visibility = 0;
  int error = 0;
  int bar = 0;
  int crop = 0;

  int images_height() const {
    int height = 0;
    for (const int row : {picture, visibility, error, bar, crop}) height += row > 0 ? row + kRowGap : 0;
    return std::max(0, height - kRowGap);
  }
};

class Builder {
 public:
  explicit Builder(const Grid& grid) : grid_(grid) {
    const int columns = std::clamp(static_cast<int>(grid.tiles.size()), 1, std::max(1, grid.columns));
    columns_ = static_cast<std::size_t>(columns);
    layout_.canvas.width = 2 * kMargin + columns * kTileWidth + (columns - 1) * kColumnGap;
    layout_.bar_scale = choose_scale_of_bars();
  }

  GridLayout build() {
    int y = kMargin;
    y = add_text(grid_.title, TextRole::kTitle, full_width(y));
    y = add_text(grid_.subtitle, TextRole::kSubtitle, full_width(y + 4)) + kBlockGap / 2;
    for (std::size_t first = 0; first < grid_.tiles.size(); first += columns_)
      y = add_block(first, std::min(first + columns_, grid_.tiles.size()), y) + kBlockGap;
    y = add_color_bar(y);
    y = add_bar_legend(y);
    y = add_text(legend(), TextRole::kLegend, full_width(y));
    layout_.canvas.height = y + kMargin;
    return std::move(layout_);
  }

 private:
  Rect full_width(int y) const { return {kMargin, y, layout_.canvas.width - 2 * kMargin, 0}; }

  std::optional<BarScale> choose_scale_of_bars() const {
    std::vector<AttributionBar> bars;
    for (const GridTile& tile : grid_.tiles)
      if (tile.attribution) bars.push_back(*tile.attribution);
    return bars.empty() ? std::nullopt : std::optional(choose_bar_scale(bars));
  }

  // What is said below a tile's bar, or instead of it.
  std::string bar_text(const GridTile& tile) const {
    if (tile.attribution) return label_bar(*tile.attribution);
    return layout_.bar_scale && has_image(tile) && !tile.no_attribution.empty()
               ? "no attribution: " + tile.no_attribution
               : std::string();
  }

  static bool has_image(const GridTile& tile) {
    return !tile.picture.empty() || !tile.visibility.empty() || !tile.error.empty();
  }

  int bar_row_height(const GridTile& tile) const {
    return (tile.attribution ? kBarHeight : 0) + text_height(bar_text(tile), TextRole::kCaption, kTileWidth);
  }

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
      rows.bar = std::max(rows.bar, bar_row_height(tile));
      for (const Image* image : {&tile.picture, &tile.visibility})
        rows.crop = std::max(rows.crop, crop_size(*image).height);
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
      if (!has_image(tile))
        bottom = std::max(bottom, add_message(tile, {x, images_y, kTileWidth, rows.images_height()}));
      else
        add_panels(i, {x, images_y, kTileWidth, 0}, rows);
    }
    return bottom;
  }

  /// One scale for the whole grid, with its bar and what its ends mean.
  int add_color_bar(int y) {
    std::vector<const Image*> errors;
    for (const GridTile& tile : grid_.tiles)
      if (!tile.error.empty()) errors.push_back(&tile.error);
    if (errors.empty()) return y;
    layout_.error_scale = grid_.error_scale ? *grid_.error_scale : choose_error_scale(errors);
    const int height = line_height(font_of(TextRole::kLegend));
    layout_.color_bar = Rect{kMargin, y, kColorBarWidth, height};
    const std::string text =
        fmt::format("{0}: -{1} (too dark, blue) to +{1} (too bright, red)", grid_.error_name, layout_.error_scale);
    const int x = kMargin + kColorBarWidth + kColumnGap;
    const int text_end = add_text(text, TextRole::kLegend, {x, y, layout_.canvas.width - kMargin - x, 0});
    return std::max(text_end, y + height) + kRowGap;
  }

  /// What the bars' colours, lengths and lines mean.
  int add_bar_legend(int y) {
    if (!layout_.bar_scale) return y;
    y = add_swatches(y);
    const std::string text = fmt::format(
        "Bars: what the error is made of, each part's share times RMSE; parts left of the grey line offset the others. "
        "The black tick is the RMSE, the full width {}.",
        records::format_number(layout_.bar_scale->length));
    return add_text(text, TextRole::kLegend, full_width(y)) + kRowGap;
  }

  int add_swatches(int y) {
    const int height = line_height(font_of(TextRole::kLegend));
    const int right = layout_.canvas.width - kMargin;
    int x = kMargin;
    for (std::size_t part = 0; part < metrics::kErrorParts; ++part) {
      const std::string name = records::list_error_parts()[part].name;
      const int width = measure_text(name, font_of(TextRole::kLegend));
      if (x > kMargin && x + height + kSwatchGap + width > right) {
        x = kMargin;
        y += height + kSwatchGap;
      }
      layout_.swatches.push_back({{x, y, height, height}, part});
      layout_.texts.push_back({{x + height + kSwatchGap, y, width, height}, name, TextRole::kLegend});
      x += height + kSwatchGap + width + kLegendGap;
    }
    return y + height + kSwatchGap;
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
    add_bar(index, {column.x, y, column.width, kBarHeight});
    y += rows.bar > 0 ? rows.bar + kRowGap : 0;
    const int half = (column.width - kRowGap) / 2;
    add_panel({column.x, y, half, rows.crop}, crop_size(tile.picture), index, PanelKind::kPictureCrop);
    add_panel({column.x + column.width - half, y, half, rows.crop}, crop_size(tile.visibility), index,
              PanelKind::kVisibilityCrop);
  }

  void add_bar(std::size_t index, const Rect& box) {
    const GridTile& tile = grid_.tiles[index];
    int text_y = box.y;
    if (tile.attribution) {
      layout_.bars.push_back(place_bar(*tile.attribution, *layout_.bar_scale, box, index));
      text_y += box.height;
    }
    add_text(bar_text(tile), TextRole::kCaption, {box.x, text_y, box.width, 0});
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
    const bool shows_visibility = std::any_of(layout_.panels.begin(), layout_.panels.end(),
                                              [](const Panel& p) { return p.kind == PanelKind::kVisibility; });
    if (!shows_visibility) return {};
    std::string text = "Top: shaded picture. Below it: visibility (white lit, black blocked)";
    text += layout_.color_bar ? ", then its error" : "";
    text += layout_.bar_scale ? ", then the parts of the error." : ".";
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
    case TextRole::kTitle: return {34, true};
    case TextRole::kLabel: return {28, true};
    case TextRole::kSubtitle:
    case TextRole::kCaption:
    case TextRole::kMessage:
    case TextRole::kLegend: break;
  }
  return {21, false};
}

Size fit_size(Size size, Size box) {
  if (size.width <= 0 || size.height <= 0) return {};
  const int factor = std::min(box.width / size.width, box.height / size.height);
  if (factor >= 1) return {size.width * factor, size.height * factor};
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

}  // namespace shadowbench::images
