#include "harness/view/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/records/error_parts.h"

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

ShownLayer show_picture(Layers& layers, const Layer&, std::size_t side) { return {picture_of(layers, side), {}}; }

ShownLayer show_visibility(Layers& layers, const Layer&, std::size_t side) {
  return {{.values = &layers.bench().stage().visibility(side, layers.columns()), .colors = Colors::kGrey}, {}};
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

/// How far the first ray towards the light goes; 0 where nothing blocks it.
images::Image make_blocker_image(const measure::SceneTruth& truth) {
  images::Image image(truth.area.width, truth.area.height, 1);
  std::ranges::transform(truth.rays.first_blockers_ws, image.texels.begin(),
                         [](float distance) { return std::isfinite(distance) ? distance : 0.0f; });
  return image;
}

ShownLayer show_texels(Layers& layers, const Layer& layer, std::size_t side) {
  Workbench& bench = layers.bench();
  bench.want_coverage();
  const auto& coverage = bench.truth().coverage;
  if (!coverage) return {picture_of(layers, side), "being counted"};
  const auto make_image = [&] {
    images::Image image = coverage->density;
    for (float& texels : image.texels) texels = std::max(texels, 0.0f);  // below 0 where there is no surface
    return image;
  };
  return {layers.upload(layer.id, bench.drawings(), make_image), {}};
}

ShownLayer show_blockers(Layers& layers, const Layer& layer, std::size_t side) {
  Workbench& bench = layers.bench();
  if (bench.state().sides[side].truth) {
    const auto& truth = bench.truth().truth;
    if (!truth || !truth->absent.empty())
      return {picture_of(layers, side), truth ? truth->absent : "the truth is being traced"};
    return {layers.upload(layer.id + ".truth", bench.drawings(), [&] { return make_blocker_image(*truth); }), {}};
  }
  return {layers.upload(layer.id, bench.drawings(), [&] { return bench.stage().blocker_distance(bench.state()); }), {}};
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
  const measure::MeasuredCell* cell = bench.find_measured(side);
  if (cell == nullptr) return {picture_of(layers, side), bench.explain_no_measurement(side)};
  const images::Image& image = find_image(*cell, layer.id);
  if (image.empty()) return {picture_of(layers, side), explain_empty(cell->record, layer)};
  DisplayedValues values = layers.upload(fmt::format("{} {}", layer.id, side), bench.drawings(), [&] { return image; });
  if (layer.id != kShortfall)
    values.colors = Colors::kDiverging, values.low = -layers.scale(), values.high = layers.scale();
  return {values, {}};
}

std::vector<Layer> make_layers() {
  std::vector<Layer> layers = {
      {"picture", "shaded picture", "", "What the eye sees: direct light times visibility, and ambient light.",
       show_picture},
      {"visibility", "visibility", "of the light", "1 is lit, 0 is in the shadow.", show_visibility},
      {"error", "signed error", "visibility", "Visibility less the ray-traced truth: red is too bright, blue too dark.",
       show_error},
      {"texels", "texels per pixel", "texels",
       "Texels of the map under a pixel's footprint: below 1 the map is too coarse, far above 1 it is wasted.",
       show_texels},
      {"blocker", "blocker distance", "m",
       "From a receiver towards the light to what the map, or for the truth the first ray, holds there.",
       show_blockers}};
  for (const records::ErrorPart& part : records::list_error_parts())
    layers.push_back({part.id, std::string("error: ") + part.name, "visibility",
                      fmt::format("A part of the signed error: {}.", part.meaning), show_measured});
  layers.push_back({kHalfDifference, "stability: 16-bit store", "visibility",
                    "Visibility with a 16-bit store less that with a 32-bit one.", show_measured});
  layers.push_back({kShortfall, "stability: broken bound", "visibility",
                    "By how much a filter that promises a bound is darker than what it bounds.", show_measured});
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
    for (const float value : image.texels) {
      if (!std::isfinite(value)) continue;
      kept.low = std::min(kept.low, value);
      kept.high = std::max(kept.high, value);
    }
    if (kept.high <= kept.low) kept.high = kept.low + 1.0f;
  }
  return {.values = &*kept.texture, .colors = Colors::kSequential, .low = kept.low, .high = kept.high};
}

}  // namespace shadowbench::view
