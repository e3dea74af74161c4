#include "harness/run/map_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/measure/filter_setup.h"
#include "harness/render/picture_passes.h"
#include "report/analysis/summary.h"
#include "report/images/grid.h"
#include "report/images/map_figures.h"
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

std::string describe_range(const render::MapSettings& map, const std::vector<scene::LightFrustum>& layers) {
  const double range_m = layers.front().depth_range_ws;
  return fmt::format("{}depth 1 is {} m from depth 0; the format holds depth in steps of {} m at most",
                     layers.size() == 1 ? "" : "in the first layer ", records::format_number(range_m),
                     records::format_number(render::find_coarsest_step(map) * range_m));
}

void write_depth(const std::filesystem::path& path, const std::string& scene, const std::string& settings,
                 const measure::SceneMeasurement& measured, const measure::LightMap& light) {
  std::vector<images::DepthLayer> layers;
  const int side = measured.stored_map.height;  // all layers stand side by side
  for (const scene::LightFrustum& layer : light.layers)
    layers.push_back({images::cut_image(measured.stored_map, {layer.layer * side, 0, side, side}), layer.depth_range_ws,
                      name_layer(layer.share)});
  images::write_figure(
      path, {scene + ": the depth map, as the light sees the scene",
             settings + " · " + describe_range(light.map.settings(), light.layers),
             images::show_depth(layers, light.map.settings().curve), std::max(2, static_cast<int>(layers.size()))});
}

/// A way to treat what lies outside the map.
struct Variant {
  const char* caption;
  filters::RangeRule rule;
};

const std::array<Variant, 4>& list_variants() {
  using filters::Border;
  static const std::array<Variant, 4> variants = {{
      {"right: outside the map and beyond its far plane is lit", {}},
      {"--border edge: the map's edge is smeared outwards", {Border::kEdge, true, true}},
      {"--border repeat: the map is tiled", {Border::kRepeat, true, true}},
      {"--far-test off: beyond the far plane is compared", {Border::kBorder, false, true}},
  }};
  return variants;
}

/// Draws tiles of one task.
class TilePainter {
 public:
  TilePainter(measure::Renderer& renderer, const options::RunOptions& options, const measure::SceneTask& task,
              measure::SceneAssets& assets)
      : renderer_(renderer),
        options_(options),
        task_(task),
        light_(assets.light_map(*task.camera, task.map_size)),
        gbuffer_(assets.gbuffer(*task.camera)),
        target_("visibility", GL_R32F, options.width, options.height) {}

  ~TilePainter() { light_.map.set_border(options_.range.border); }
  TilePainter(const TilePainter&) = delete;
  TilePainter& operator=(const TilePainter&) = delete;

  images::GridTile draw(const filters::FilterRequest& request, const Variant& variant) {
    render::LightLayers light = measure::make_filter_light(options_, task_.scene->light, light_.layers, request);
    for (render::LightSetup& layer : light) layer.range = variant.rule;
    light_.map.set_border(variant.rule.border);
    render::FilterPasses passes(renderer_.shaders, request, light_.map, light);
    images::GridTile tile;
    tile.visibility = measure::draw_visibility(passes, light_.map, gbuffer_, target_);
    tile.label = request.label();
    tile.caption = variant.caption;
    tile.picture =
        render::shade(renderer_.shaders, gbuffer_, target_.texture(), *task_.scene, *task_.camera, variant.rule);
    return tile;
  }

 private:
  measure::Renderer& renderer_;
  const options::RunOptions& options_;
  const measure::SceneTask& task_;
  measure::LightMap& light_;
  render::GBuffer& gbuffer_;
  render::ImageTarget target_;
};

}  // namespace

std::vector<FileJob> plan_map_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                                       measure::SceneMeasurement& measured, const measure::MapCoverage& coverage,
                                       const measure::LightMap& light) {
  const std::string base = "images/" + task_stem(options, task);
  const std::string depth = base + ".depth_map.png", density = base + ".texel_density.png",
                    grid = base + ".texel_grid.png";
  const std::string& scene = task.scene->name;
  const std::string settings = records::describe_settings(measured.cells.front().record);
  const std::string note = settings + " · " + records::describe_coverage(coverage.record);
  const measure::MeasuredCell* background = choose_background(measured.cells);
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.depth_map = depth;
    cell.record.images.texel_density = density;
    if (background) cell.record.images.texel_grid = grid;
  }
  std::vector<FileJob> jobs = {
      [file = options.out / depth, scene, settings, &measured, &light] {
        write_depth(file, scene, settings, measured, light);
      },
      [file = options.out / density, scene, note, &coverage] {
        images::write_figure(file, {scene + ": map texels per pixel", note, {images::show_density(coverage.density)}});
      }};
  if (!background) return jobs;
  jobs.emplace_back([file = options.out / grid, scene, note, background, &coverage] {
    images::write_figure(file, {fmt::format("{}: the map's texels on the surfaces, over {}", scene, background->label),
                                note,
                                {images::show_texels(background->picture, coverage.texel, coverage.density)}});
  });
  return jobs;
}

void write_border_page(const std::filesystem::path& file, measure::Renderer& renderer,
                       const options::RunOptions& options, const measure::SceneTask& task,
                       measure::SceneAssets& assets) {
  TilePainter painter(renderer, options, task, assets);
  images::Grid grid;
  grid.title = fmt::format("{}: what lies outside the map", task.scene->name);
  grid.subtitle =
      fmt::format("{} · view {} · map {} × {}", task.scene->title, task.camera->name, task.map_size, task.map_size);
  grid.columns = static_cast<int>(list_variants().size());
  for (const filters::FilterRequest& request : task.filters) {
    if (request.user_file) continue;
    for (const Variant& variant : list_variants()) grid.tiles.push_back(painter.draw(request, variant));
  }
  if (!grid.tiles.empty()) images::write_grid(file, grid);
}

}  // namespace shadowbench::run
