#include "harness/run/border_page.h"

#include <fmt/format.h>

#include <array>

#include "harness/measure/filter_setup.h"
#include "harness/render/shade_pass.h"
#include "report/images/grid.h"

namespace shadowbench::run {
namespace {

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
