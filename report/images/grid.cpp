#include "report/images/grid.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "report/images/color_values.h"
#include "report/images/grid_layout.h"
#include "report/images/picture_io.h"
#include "report/images/text.h"

namespace shadowbench::images {
namespace {

constexpr Rgb kBackground{1.0f, 1.0f, 1.0f};
constexpr Rgb kInk{0.11f, 0.12f, 0.14f};
constexpr Rgb kSecondInk{0.33f, 0.35f, 0.39f};
constexpr Rgb kFrame{0.72f, 0.74f, 0.77f};
constexpr Rgb kOutline{0.93f, 0.32f, 0.05f};
constexpr Rgb kMessageBackground{0.98f, 0.93f, 0.90f};
constexpr Rgb kMessageInk{0.55f, 0.15f, 0.05f};
constexpr Rgb kNotFinite{1.0f, 0.0f, 1.0f};
constexpr Rgb kTrack{0.95f, 0.95f, 0.95f};
constexpr Rgb kZeroLine{0.45f, 0.47f, 0.50f};
constexpr Rgb kNetTick{0.0f, 0.0f, 0.0f};
constexpr int kOutlineWidth = 2;

void fill_rect(Image& canvas, const Rect& rect, const Rgb& color) {
  for (int y = std::max(0, rect.y); y < std::min(canvas.height, rect.y + rect.height); ++y)
    for (int x = std::max(0, rect.x); x < std::min(canvas.width, rect.x + rect.width); ++x)
      std::copy(color.begin(), color.end(), canvas.at(x, y));
}

// Draws a line of `width` pixels around a rectangle, outside it.
void frame_rect(Image& canvas, const Rect& r, int width, const Rgb& color) {
  const int outer = r.width + 2 * width;
  fill_rect(canvas, {r.x - width, r.y - width, outer, width}, color);
  fill_rect(canvas, {r.x - width, r.y + r.height, outer, width}, color);
  fill_rect(canvas, {r.x - width, r.y, width, r.height}, color);
  fill_rect(canvas, {r.x + r.width, r.y, width, r.height}, color);
}

Image cut_image(const Image& image, const Rect& rect) {
  Image result(rect.width, rect.height, image.channels);
  for (int y = 0; y < rect.height; ++y) {
    const float* row = image.at(rect.x, rect.y + y);
    std::copy(row, row + rect.width * image.channels, result.at(0, y));
  }
  return result;
}

Image magnify_image(const Image& image, int factor) {
  Image result(image.width * factor, image.height * factor, image.channels);
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      const float* texel = image.at(x / factor, y / factor);
      std::copy(texel, texel + image.channels, result.at(x, y));
    }
  }
  return result;
}

// A triangle filter has no negative lobes, so no bright seams beside a shadow's edge that no filter made.
Image reduce_image(const Image& image, Size size) {
  Image result(size.width, size.height, image.channels);
  const OIIO::ImageSpec from(image.width, image.height, image.channels, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageSpec to(size.width, size.height, image.channels, OIIO::TypeDesc::FLOAT);
  const OIIO::ImageBuf source(from, const_cast<float*>(image.texels.data()));
  OIIO::ImageBuf target(to, result.texels.data());
  [[maybe_unused]] const bool resized = OIIO::ImageBufAlgo::resize(target, source, "triangle", 0.0f, OIIO::get_roi(to));
  assert(resized);
  return result;
}

Image fit_image(const Image& image, const Rect& box) {
  const int factor = box.width / image.width;
  if (factor >= 1 && box.width == image.width * factor && box.height == image.height * factor)
    return magnify_image(image, factor);
  return reduce_image(image, {box.width, box.height});
}

Rgb display_color(const float* texel, int channels, float exposure) {
  if (!std::all_of(texel, texel + channels, [](float value) { return std::isfinite(value); })) return kNotFinite;
  if (channels == 1) {
    const float grey = std::clamp(*texel, 0.0f, 1.0f);
    return {grey, grey, grey};
  }
  return {encode_srgb(texel[0] * exposure), encode_srgb(texel[1] * exposure), encode_srgb(texel[2] * exposure)};
}

// The crop as shown in a panel of the whole picture.
Rect scale_crop(const Rect& crop, const Image& image, const Rect& box) {
  const double sx = static_cast<double>(box.width) / image.width;
  const double sy = static_cast<double>(box.height) / image.height;
  const int left = static_cast<int>(std::floor(crop.x * sx));
  const int top = static_cast<int>(std::floor(crop.y * sy));
  return {box.x + left, box.y + top, static_cast<int>(std::ceil((crop.x + crop.width) * sx)) - left,
          static_cast<int>(std::ceil((crop.y + crop.height) * sy)) - top};
}

Rect intersect(const Rect& a, const Rect& b) {
  const int left = std::max(a.x, b.x);
  const int top = std::max(a.y, b.y);
  return {left, top, std::min(a.x + a.width, b.x + b.width) - left, std::min(a.y + a.height, b.y + b.height) - top};
}

// Draws the crop's outline without leaving the panel.
void outline_crop(Image& canvas, const Rect& crop, const Rect& box) {
  const int w = kOutlineWidth;
  const int outer = crop.width + 2 * w;
  for (const Rect& side : {Rect{crop.x - w, crop.y - w, outer, w}, Rect{crop.x - w, crop.y + crop.height, outer, w},
                           Rect{crop.x - w, crop.y, w, crop.height}, Rect{crop.x + crop.width, crop.y, w, crop.height}})
    fill_rect(canvas, intersect(side, box), kOutline);
}

Image color_errors(const Image& errors, double scale) {
  Image colored(errors.width, errors.height, 3);
  for (std::size_t i = 0; i < errors.texels.size(); ++i) {
    const float value = errors.texels[i];
    const Rgb color = std::isfinite(value) ? map_diverging(value, static_cast<float>(scale)) : kNotFinite;
    std::copy(color.begin(), color.end(), colored.texels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return colored;
}

// Draws display values as they are.
void draw_display_image(Image& canvas, const Image& image, const Rect& box) {
  const Image shown = fit_image(image, box);
  for (int y = 0; y < shown.height; ++y) {
    const float* row = shown.at(0, y);
    std::copy(row, row + 3 * shown.width, canvas.at(box.x, box.y + y));
  }
  frame_rect(canvas, box, 1, kFrame);
}

void draw_color_bar(Image& canvas, const Rect& box, double scale) {
  Image bar(box.width, box.height, 1);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) *bar.at(x, y) = static_cast<float>(scale * (2.0 * (x + 0.5) / box.width - 1.0));
  draw_display_image(canvas, color_errors(bar, scale), box);
}

void draw_panel(Image& canvas, const Grid& grid, const Panel& panel) {
  const GridTile& tile = grid.tiles[panel.tile];
  const bool is_crop = panel.kind == PanelKind::kPictureCrop || panel.kind == PanelKind::kVisibilityCrop;
  const bool is_picture = panel.kind == PanelKind::kPicture || panel.kind == PanelKind::kPictureCrop;
  const Image& image = is_picture ? tile.picture : tile.visibility;
  const Rect crop = clip_crop(grid.crop, image);
  const Image shown = fit_image(is_crop ? cut_image(image, crop) : image, panel.box);
  for (int y = 0; y < shown.height; ++y) {
    for (int x = 0; x < shown.width; ++x) {
      const Rgb color = display_color(shown.at(x, y), shown.channels, static_cast<float>(grid.exposure));
      std::copy(color.begin(), color.end(), canvas.at(panel.box.x + x, panel.box.y + y));
    }
  }
  frame_rect(canvas, panel.box, is_crop ? kOutlineWidth : 1, is_crop ? kOutline : kFrame);
  if (!is_crop && crop.width > 0 && crop.height > 0)
    outline_crop(canvas, scale_crop(crop, image, panel.box), panel.box);
}

// The zero line shows above and below the parts only; the tick of the RMSE lies over them.
void draw_bar(Image& canvas, const BarPlace& bar) {
  fill_rect(canvas, bar.track, kTrack);
  fill_rect(canvas, bar.zero_line, kZeroLine);
  for (const SegmentBox& segment : bar.segments)
    fill_rect(canvas, segment.box, records::list_error_parts()[segment.part].color);
  fill_rect(canvas, bar.net_tick, kNetTick);
}

void draw_bars(Image& canvas, const GridLayout& layout) {
  for (const BarPlace& bar : layout.bars) draw_bar(canvas, bar);
  for (const Swatch& swatch : layout.swatches)
    fill_rect(canvas, swatch.box, records::list_error_parts()[swatch.part].color);
}

Rgb ink_of(TextRole role) {
  switch (role) {
    case TextRole::kTitle:
    case TextRole::kLabel: return kInk;
    case TextRole::kMessage: return kMessageInk;
    case TextRole::kSubtitle:
    case TextRole::kCaption:
    case TextRole::kLegend: break;
  }
  return kSecondInk;
}

}  // namespace

Image draw_grid(const Grid& grid) {
  const GridLayout layout = layout_grid(grid);
  Image canvas(layout.canvas.width, layout.canvas.height, 3);
  fill_rect(canvas, {0, 0, canvas.width, canvas.height}, kBackground);
  for (const Rect& box : layout.message_boxes) fill_rect(canvas, box, kMessageBackground);
  for (const Panel& panel : layout.panels)
    if (panel.kind == PanelKind::kError)
      draw_display_image(canvas, color_errors(grid.tiles[panel.tile].error, layout.error_scale), panel.box);
    else
      draw_panel(canvas, grid, panel);
  if (layout.color_bar) draw_color_bar(canvas, *layout.color_bar, layout.error_scale);
  draw_bars(canvas, layout);
  for (const TextLine& line : layout.texts)
    draw_text(canvas, line.box.x, line.box.y, line.text, font_of(line.role), ink_of(line.role));
  return canvas;
}

void write_grid(const std::filesystem::path& path, const Grid& grid) { write_display_png(path, draw_grid(grid)); }

}  // namespace shadowbench::images
