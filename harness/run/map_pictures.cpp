#include "harness/run/map_pictures.h"

#include <fmt/format.h>

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

void write_depth(const std::filesystem::path& path, const std::string& scene, const std::string& settings,
                 const render::MapSettings& map, const measure::SceneMeasurement& measured,
                 const scene::LightFrustum& frustum) {
  images::DepthPicture picture;
  picture.title = scene + ": the depth map, as the light sees the scene";
  picture.note = fmt::format("{} · depth 1 is {} m from depth 0; the format holds depth in steps of {} m at most",
                             settings, records::format_number(frustum.depth_range_ws),
                             records::format_number(render::find_coarsest_step(map) * frustum.depth_range_ws));
  picture.stored = measured.stored_map;
  picture.curve = map.curve;
  picture.range_m = frustum.depth_range_ws;
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
  write_depth(options.out / depth, scene, settings, light.map.settings(), measured, light.frustum);
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
