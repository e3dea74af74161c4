#include "harness/view/layers.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "report/records/format.h"

namespace shadowbench::view {
namespace {

using render::Colors;
using render::DisplayedValues;

constexpr const char *kHalfDifference = "half_difference", *kShortfall = "shortfall";

DisplayedValues picture_of(Layers& layers, std::size_t side) {
  Workbench& bench = layers.bench();
  return {&bench.stage().picture(bench.state(), side, layers.columns())};
}

/// Why a layer of a measured cell does not exist.
std::string explain_empty(const records::CellRecord& record, const Layer& layer) {
  for (const std::string& field : {"attribution." + layer.id, std::string("attribution"), "stability." + layer.id,
                                   std::string("stability"), std::string("error")})
    if (const auto reason = record.absent.find(field); reason != record.absent.end()) return reason->second;
  return record.message.empty() ? "the filter has none" : record.message;
}

/// Why a side does not show what it is to show: a truth that is not there yet is lit everywhere.
std::string explain_missing(const Workbench& bench, std::size_t side) {
  return bench.state().sides[side].truth ? bench.explain_no_truth() : std::string();
}

ShownLayer show_picture(Layers& layers, const Layer&, std::size_t side) {
  return {picture_of(layers, side), explain_missing(layers.bench(), side)};
}

ShownLayer show_visibility(Layers& layers, const Layer&, std::size_t side) {
  return {{.values = &layers.bench().stage().visibility(side, layers.columns()), .colors = Colors::kGrey},
          explain_missing(layers.bench(), side)};
}

ShownLayer show_error(Layers& layers, const Layer&, std::size_t side) {
  Stage& stage = layers.bench().stage();
  if (!stage.truth()) return {picture_of(layers, side), layers.bench().explain_no_truth()};
  return {{.values = &stage.visibility(side, layers.columns()),
           .less = stage.truth(),
           .colors = Colors::kDiverging,
           .low = -layers.scale(),
           .high = layers.scale()},
          {}};
}

ShownLayer show_texels(Layers& layers, const Layer& layer, std::size_t) {
  Workbench& bench = layers.bench();
  return {layers.upload(layer.id, bench.drawings(), [&] { return bench.stage().texels_per_pixel(bench.state()); }), {}};
}

/// What was measured of a cell's pixels; an empty image where that does not exist.
const images::Image& find_image(const measure::MeasuredCell& cell, const std::string& layer) {
  static const images::Image kNone;
  if (layer == kHalfDifference) return cell.stability.half_difference;
  if (layer == kShortfall) return cell.stability.shortfall;
  for (std::size_t i = 0; i < cell.error_parts.size(); ++i)
    if (records::list_error_parts()[i].id == layer) return cell.error_parts[i];
  return kNone;
}

/// A measured image in colours.
ShownLayer show_measured(Layers& layers, const Layer& layer, std::size_t side) {
  Workbench& bench = layers.bench();
  bench.want_measurement();
  if (bench.state().sides[side].truth) return {picture_of(layers, side), "the truth has no error"};
  const measure::MeasuredCell* cell = bench.find_measured(side);
  if (cell == nullptr) return {picture_of(layers, side), bench.explain_no_measurement()};
  const images::Image& image = find_image(*cell, layer.id);
  if (image.empty()) return {picture_of(layers, side), explain_empty(cell->record, layer)};
  DisplayedValues values = layers.upload(fmt::format("{} {}", layer.id, side), bench.drawings(), [&] { return image; });
  if (layer.id != kShortfall)
    values.colors = Colors::kDiverging, values.low = -layers.scale(), values.high = layers.scale();
  return {values, {}};
}

std::vector<Layer> make_layers() {
  std::vector<Layer> layers = {
      {"picture", "shaded picture", "", "Direct light times visibility, plus ambient light.", show_picture},
      {"visibility", "visibility", "of the light", "1 is lit, 0 is in the shadow.", show_visibility},
      {"error", "signed error", "visibility",
       "Visibility minus the ray-traced truth: red is too bright, blue too dark.", show_error},
      {"texels", "texels per pixel", "texels",
       "Texels of the map under a pixel's footprint: below 1 the map is too coarse, far above 1 it is wasted.",
       show_texels}};
  for (const records::ErrorPart& part : records::list_error_parts())
    layers.push_back({part.id, std::string("error: ") + part.name, "visibility",
                      fmt::format("A part of the signed error: {}.", part.meaning), show_measured});
  layers.push_back({kHalfDifference, "stability: 16-bit store", "visibility",
                    "Visibility with a 16-bit store minus visibility with a 32-bit store.", show_measured});
  layers.push_back({kShortfall, "stability: broken bound", "visibility",
                    "How much darker than its bound a filter is that promises one.", show_measured});
  return layers;
}

}  // namespace

const std::vector<Layer>& Layers::list() {
  static const std::vector<Layer> layers = make_layers();
  return layers;
}

ShownLayer Layers::show(const Layer& layer, std::size_t side, float scale, const glm::ivec2& columns) {
  scale_ = scale;
  columns_ = columns;
  return layer.show(*this, layer, side);
}

DisplayedValues Layers::upload(const std::string& id, std::uint64_t version,
                               const std::function<images::Image()>& make_image) {
  Kept& kept = kept_[id];
  if (!kept.texture || kept.version != version) {
    const images::Image image = make_image();
    kept.version = version;
    kept.texture.reset();
    kept.texture.emplace(render::upload_image(image));
    kept.low = kept.high = 0.0f;
    kept.infinite =
        static_cast<std::size_t>(std::ranges::count_if(image.texels, [](float v) { return std::isinf(v); }));
    for (const float value : image.texels) {
      if (!std::isfinite(value)) continue;
      kept.low = std::min(kept.low, value);
      kept.high = std::max(kept.high, value);
    }
    if (kept.high <= kept.low) kept.high = kept.low + 1.0f;
  }
  return {.values = &*kept.texture,
          .colors = Colors::kSequential,
          .low = kept.low,
          .high = kept.high,
          .infinite = kept.infinite};
}

namespace {

constexpr int kScaleSteps = 64;
constexpr ImU32 kCaptionBack = IM_COL32(20, 20, 22, 220);
constexpr ImU32 kCaptionInk = IM_COL32(240, 240, 240, 255);
constexpr ImU32 kHiddenInk = IM_COL32(150, 150, 150, 255);

}  // namespace

glm::vec2 text_size(const std::string& text, float room) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, room > 0.0f ? room : -1.0f);
  return {size.x, size.y};
}

void draw_caption(const glm::vec2& corner, const std::string& text, const glm::vec2& size, bool is_hidden) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const float edge = 0.3f * ImGui::GetFontSize();
  list->AddRectFilled({corner.x - edge, corner.y - edge}, {corner.x + size.x + edge, corner.y + size.y + edge},
                      kCaptionBack, 3.0f);
  list->AddText(nullptr, 0.0f, {corner.x, corner.y}, is_hidden ? kHiddenInk : kCaptionInk, text.c_str(), nullptr,
                size.x + 1.0f);
}

ScaleCaption::ScaleCaption(const Layer& layer, const render::DisplayedValues& values)
    : color(color_function(values.colors)) {
  const bool is_signed = values.colors == render::Colors::kDiverging, is_grey = values.colors == render::Colors::kGrey;
  low = fmt::format("{}: {:.3g}{}", layer.title, values.low, is_signed ? " darker" : is_grey ? " shadow" : "");
  high = is_signed ? fmt::format("{:+.3g} lighter", values.high)
                   : fmt::format("{:.3g} {}", values.high, is_grey ? "lit" : layer.unit);
}

glm::vec2 ScaleCaption::draw(const glm::vec2& corner) const {
  const float gap = 0.5f * ImGui::GetFontSize(), bar = 6.0f * ImGui::GetFontSize(), step = bar / kScaleSteps;
  const float before = text_size(low).x + gap;
  const glm::vec2 size = {before + bar + gap + text_size(high).x, ImGui::GetFontSize()};
  draw_caption(corner, low, size);
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  for (int i = 0; i < kScaleSteps; ++i) {
    const images::Rgb rgb = color((static_cast<float>(i) + 0.5f) / kScaleSteps);
    const float x = corner.x + before + static_cast<float>(i) * step;
    list->AddRectFilled({x, corner.y + 1.0f}, {x + step, corner.y + size.y - 1.0f},
                        ImGui::ColorConvertFloat4ToU32({rgb[0], rgb[1], rgb[2], 1.0f}));
  }
  list->AddText({corner.x + before + bar + gap, corner.y}, kCaptionInk, high.c_str());
  return size;
}

}  // namespace shadowbench::view
