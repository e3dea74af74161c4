#include "harness/run/map_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/run/task_images.h"
#include "report/analysis/summary.h"
#include "report/images/figures/depth_picture.h"
#include "report/images/figures/texel_pictures.h"
#include "report/records/format.h"

namespace shadowbench::run {
namespace {

/// The picture to lay the texels over: unfiltered where there is one, so that aliasing shows; null where nothing was
/// drawn.
const measure::MeasuredCell* choose_background(const std::vector<measure::MeasuredCell>& cells) {
  const measure::MeasuredCell* chosen = nullptr;
  for (const measure::MeasuredCell& cell : cells) {
    if (cell.picture.empty()) continue;
    if (!chosen || cell.record.filter == "none") chosen = &cell;
  }
  return chosen;
}

std::string name_layer(const scene::LayerShare& share) {
  constexpr std::array<const char*, 6> kFaces = {"+x", "-x", "+y", "-y", "+z", "-z"};
  if (const auto* face = std::get_if<scene::CubeFace>(&share))
    return fmt::format("face {}", kFaces[static_cast<std::size_t>(face->index)]);
  if (const auto* half = std::get_if<scene::HalfSphere>(&share)) return half->is_upper ? "upper half" : "lower half";
  if (const auto* slice = std::get_if<scene::ViewSlice>(&share))
    return fmt::format("to {} m", records::format_number(slice->end_m));
  return {};
}

/// A layer's part of a picture in which all stand side by side.
images::Image cut_layer(const images::Image& all, int layer) {
  const int side = all.height;
  images::Image cut(side, side, 1);
  for (int y = 0; y < side; ++y) std::copy_n(all.at(layer * side, y), side, cut.at(0, y));
  return cut;
}

std::string describe_range(const render::MapSettings& map, const std::vector<scene::LightFrustum>& layers) {
  const double range_m = layers.front().depth_range_ws;
  return fmt::format("{}depth 1 is {} m from depth 0; the format holds depth in steps of {} m at most",
                     layers.size() == 1 ? "" : "in the first layer ", records::format_number(range_m),
                     records::format_number(render::find_coarsest_step(map) * range_m));
}

void write_depth(const std::filesystem::path& path, const std::string& scene, const std::string& settings,
                 const measure::SceneMeasurement& measured, const measure::LightMap& light) {
  images::DepthPicture picture;
  picture.title = scene + ": the depth map, as the light sees the scene";
  picture.note = settings + " · " + describe_range(light.map.settings(), light.layers);
  picture.curve = light.map.settings().curve;
  for (const scene::LightFrustum& layer : light.layers)
    picture.layers.push_back(
        {cut_layer(measured.stored_map, layer.layer), layer.depth_range_ws, name_layer(layer.share)});
  images::write_depth_picture(path, picture);
}

}  // namespace

void write_map_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                        measure::SceneMeasurement& measured, const measure::MapCoverage& coverage,
                        const measure::LightMap& light) {
  const std::string base = "images/" + task_stem(options, task);
  const std::string depth = base + ".depth_map.png", density = base + ".texel_density.png",
                    grid = base + ".texel_grid.png";
  const std::string& scene = task.scene->name;
  const std::string settings = records::describe_settings(measured.cells.front().record);
  const std::string note = settings + " · " + records::describe_coverage(coverage.record);
  write_depth(options.out / depth, scene, settings, measured, light);
  images::write_density_picture(options.out / density, {scene + ": map texels per pixel", note, coverage.density});
  const measure::MeasuredCell* background = choose_background(measured.cells);
  if (background) {
    images::write_texel_grid_picture(
        options.out / grid, {fmt::format("{}: the map's texels on the surfaces, over {}", scene, background->label),
                             note, background->picture, coverage.texel, coverage.density});
  }
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.depth_map = depth;
    cell.record.images.texel_density = density;
    if (background) cell.record.images.texel_grid = grid;
  }
}

}  // namespace shadowbench::run
