#include "harness/run/task_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/files.h"
#include "harness/render/picture_passes.h"
#include "report/images/color_values.h"
#include "report/images/crop.h"
#include "report/images/heat_figures.h"
#include "report/images/picture_io.h"
#include "report/images/value_file.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"

namespace shadowbench::run {
namespace {

/// What is only looked at takes less room in steps of so many codes of its file: where low bytes repeat, they pack.
images::Image round_values(images::Image image, double codes, double range) {
  const auto step = static_cast<float>(codes * range / images::kHighestCode);
  for (float& value : image.texels) value = step * std::round(value / step);
  return image;
}

/// Keeps 8 significant bits of values that span decades.
images::Image round_significant(images::Image image) {
  for (float& value : image.texels) {
    int exponent = 0;
    const float fraction = std::frexp(value, &exponent);
    if (std::isfinite(value)) value = std::ldexp(std::round(256.0f * fraction) / 256.0f, exponent);
  }
  return image;
}

/// What the page's viewer shows of a cell beside its picture.
images::ValuePlanes list_planes(const measure::MeasuredCell& cell) {
  images::ValuePlanes planes = {{"visibility", cell.visibility}};
  for (std::size_t p = 0; p < cell.error_parts.size(); ++p)
    if (!cell.error_parts[p].empty())
      planes.emplace_back(records::list_error_parts()[p].id, round_values(cell.error_parts[p], 16.0, 2.0));
  if (!cell.flip.empty()) planes.emplace_back("flip", round_values(cell.flip, 256.0, 1.0));
  for (const images::StabilityImage& each : images::list_stability_images())
    if (const images::Image& image = cell.stability.*each.image; image.texels.size() == cell.visibility.texels.size())
      planes.emplace_back(fmt::format("stability.{}", each.id), round_significant(image));
  if (!cell.uncertainty.rounding.empty()) planes.emplace_back("rounding", round_significant(cell.uncertainty.rounding));
  return planes;
}

/// No two labels share a file.
void note_cell_pictures(const std::string& stem, measure::MeasuredCell& cell) {
  if (cell.picture.empty()) return;
  const std::string base = "images/" + stem + "." + make_file_stem(cell.label);
  cell.record.images.picture = base + ".picture.png";
  cell.record.images.visibility = base + ".visibility.png";
  cell.record.images.values = base + ".values.js";
}

/// Writes what is noted of a cell; visibility is hatched where `mask`, if there is one, has no receiver.
void write_noted_pictures(const std::filesystem::path& out, const measure::MeasuredCell& cell,
                          const std::vector<std::uint8_t>& mask) {
  const records::ImagesRecord& images = cell.record.images;
  if (!images.picture) return;
  images::write_picture_png(out / *images.picture, cell.picture);
  if (mask.empty()) {
    images::write_grey_png(out / *images.visibility, cell.visibility);
  } else {
    images::Image shown = images::color_values(cell.visibility, images::map_grey);
    images::hatch_image(shown, images::make_image(shown.width, shown.height, mask));
    images::write_display_png(out / *images.visibility, shown);
  }
  images::write_value_file(out / *images.values, *images.values, list_planes(cell));
}

/// What the page's viewer shows of the truth.
FileJob plan_truth_pictures(const std::filesystem::path& out, const std::string& stem,
                            measure::SceneMeasurement& measured, const measure::SceneTruth& truth) {
  const std::string picture = "images/" + stem + ".truth.area.png", values = "images/" + stem + ".truth.area.values.js";
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.truth_picture = picture;
    cell.record.images.truth_values = values;
  }
  return [out, picture, values, &truth] {
    images::write_picture_png(out / picture, truth.area_picture);
    images::write_value_file(
        out / values, values,
        {{"area", truth.area},
         {"hard", truth.hard},
         {"standard_error", images::make_image(truth.area.width, truth.area.height, truth.standard_errors)},
         {"mask", images::make_image(truth.area.width, truth.area.height, truth.mask)}});
  };
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
    layers.push_back(
        {images::cut_image(measured.stored_map, {layer.layer * side, 0, side, side}), name_layer(layer.share)});
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

/// Draws pictures and visibility of one task.
class TilePainter {
 public:
  explicit TilePainter(const measure::TaskRig& rig)
      : rig_(rig), light_(rig.light()), target_("visibility", GL_R32F, rig.options.width, rig.options.height) {}

  ~TilePainter() { light_.map.set_border(rig_.options.range.border); }
  TilePainter(const TilePainter&) = delete;
  TilePainter& operator=(const TilePainter&) = delete;

  images::Stack draw(const filters::FilterRequest& request, const Variant& variant) {
    const measure::SceneTask& task = rig_.task;
    render::LightLayers light = measure::make_filter_light(rig_.options, task.scene->light, light_.layers, request);
    for (render::LightSetup& layer : light) layer.range = variant.rule;
    light_.map.set_border(variant.rule.border);
    render::FilterPasses passes(rig_.renderer.shaders, request, light_.map, light);
    const images::Image visibility = measure::draw_visibility(passes, light_.map, rig_.gbuffer(), target_);
    const images::Image picture = render::shade(rig_.renderer.shaders, rig_.gbuffer(), target_.texture(), *task.scene,
                                                *task.camera, variant.rule);
    return {{request.label(), variant.caption, images::show_picture(picture)},
            {"", "", images::show_visibility(visibility)}};
  }

 private:
  const measure::TaskRig& rig_;
  measure::LightMap& light_;
  render::ImageTarget target_;
};

}  // namespace

images::Rect choose_crop(const std::vector<measure::MeasuredCell>& cells, images::Size size) {
  const auto is_suspect = [](const measure::MeasuredCell& cell) { return !cell.record.suspect_of.empty(); };
  const bool all_are = std::ranges::all_of(cells, is_suspect);
  std::vector<const images::Image*> visibility;
  std::size_t reference = 0;
  for (const measure::MeasuredCell& cell : cells) {
    if (is_suspect(cell) && !all_are) continue;
    if (cell.record.filter == "none") reference = visibility.size();
    visibility.push_back(&cell.visibility);
  }
  return images::find_disputed_edge(visibility, reference, size);
}

std::string task_stem(const options::RunOptions& options, const measure::SceneTask& task) {
  std::string name = task.scene->name;
  if (task.scene->cameras.size() > 1) name += "." + task.camera->name;
  if (options.map_sizes.size() > 1) name += fmt::format(".map{}", task.map_size);
  if (options.fits.size() > 1)
    name += "." + records::make_fit_stem(scene::describe_fit(options.fit), scene::describe_fits(options.fits));
  if (options.sizes.size() > 1) name += fmt::format(".{}x{}", options.width, options.height);
  return make_file_stem(name);
}

void write_cell_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                         measure::MeasuredCell& cell, const std::vector<std::uint8_t>& mask) {
  note_cell_pictures(task_stem(options, task), cell);
  write_noted_pictures(options.out, cell, mask);
}

std::vector<FileJob> plan_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                                   measure::SceneMeasurement& measured, const measure::SceneTruth& truth) {
  const std::string stem = task_stem(options, task);
  std::vector<FileJob> jobs;
  for (measure::MeasuredCell& cell : measured.cells) {
    note_cell_pictures(stem, cell);
    jobs.emplace_back([&out = options.out, &cell, &mask = truth.mask] { write_noted_pictures(out, cell, mask); });
  }
  if (truth.absent.empty()) jobs.push_back(plan_truth_pictures(options.out, stem, measured, truth));
  return jobs;
}

std::string name_grid(const options::RunOptions& options, const measure::SceneTask& task) {
  return task_stem(options, task) + (options.grid_width.in_inches ? ".grid.svg" : ".grid.png");
}

std::vector<FileJob> plan_map_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                                       measure::SceneMeasurement& measured, const measure::MapCoverage& coverage,
                                       const measure::LightMap& light) {
  const std::string base = "images/" + task_stem(options, task);
  const std::string depth = base + ".depth_map.png", density = base + ".texel_density.png";
  const std::string& scene = task.scene->name;
  const std::string settings = records::describe_settings(measured.cells.front().record);
  const std::string note = settings + " · " + records::describe_coverage(coverage.record);
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.depth_map = depth;
    cell.record.images.texel_density = density;
  }
  return {
      [file = options.out / depth, scene, settings, &measured, &light] {
        write_depth(file, scene, settings, measured, light);
      },
      [file = options.out / density, scene, note, &coverage] {
        images::write_figure(file, {scene + ": map texels per pixel", note, {images::show_density(coverage.density)}});
      }};
}

void write_border_page(const std::filesystem::path& file, const measure::TaskRig& rig) {
  TilePainter painter(rig);
  const measure::SceneTask& task = rig.task;
  images::Figure figure{
      fmt::format("{}: what lies outside the map", task.scene->name),
      fmt::format("{} · view {} · map {} × {}", task.scene->title, task.camera->name, task.map_size, task.map_size)};
  figure.columns = static_cast<int>(list_variants().size());
  for (const filters::FilterRequest& request : task.filters) {
    if (request.user_file) continue;
    for (const Variant& variant : list_variants()) figure.stacks.push_back(painter.draw(request, variant));
  }
  if (!figure.stacks.empty()) images::write_figure(file, figure);
}

}  // namespace shadowbench::run
