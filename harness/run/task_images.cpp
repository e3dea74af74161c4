#include "harness/run/task_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <utility>

#include "harness/measure/stability_meter.h"
#include "harness/run/provenance.h"
#include "report/analysis/summary.h"
#include "report/files/file_name.h"
#include "report/images/color_values.h"
#include "report/images/grid.h"
#include "report/images/picture_io.h"
#include "report/images/value_file.h"
#include "report/records/cell_names.h"
#include "report/records/format.h"

namespace shadowbench::run {
namespace {

std::string caption(const records::CellRecord& cell, const records::GlRecord& gl) {
  std::string text = records::describe_params(cell.params);
  if (!cell.suspect_of.empty()) text += fmt::format("{}SUSPECT: see the report", text.empty() ? "" : " · ");
  if (!cell.time_ms.lookup) return text;
  if (!text.empty()) text += " · ";
  text += fmt::format("lookup {} ms", records::format_number(cell.time_ms.lookup->median));
  if (cell.time_ms.prefilter)
    text += fmt::format(" + prefilter {} ms", records::format_number(cell.time_ms.prefilter->median));
  text += gl.software ? " (CPU)" : " (GPU)";
  if (cell.error.rmse) text += fmt::format(" · RMSE {}", records::format_number(*cell.error.rmse));
  return text;
}

/// The truth comes first: what every filter would like to look like.
std::vector<images::GridTile> make_truth_tiles(const measure::SceneTask& task, const measure::SceneTruth& truth) {
  if (!truth.absent.empty()) return {};
  const std::string sun = fmt::format("rays to {}, standard error {}", scene::describe_light(task.scene->light),
                                      records::format_number(truth.standard_error));
  return {{"truth, hard", "one ray to the light's centre", truth.hard_picture, truth.hard,
           measure::make_error_image(truth.hard, truth), ""},
          {"truth, area", sun, truth.area_picture, truth.area, measure::make_error_image(truth.area, truth), ""}};
}

/// One scale for the pictures of a task, so that they compare; what suspect cells make does not count. The last tiles
/// are those of the cells. Nothing where there are no errors.
std::optional<double> choose_error_scale(const std::vector<images::GridTile>& tiles,
                                         const std::vector<measure::MeasuredCell>& cells) {
  std::vector<const images::Image*> errors;
  const std::size_t others = tiles.size() - cells.size();
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const bool is_suspect = i >= others && cells[i - others].record.status == records::CellStatus::kSuspect;
    if (!is_suspect && !tiles[i].error.empty()) errors.push_back(&tiles[i].error);
  }
  if (errors.empty()) return std::nullopt;
  return images::choose_error_scale(errors);
}

images::Grid make_grid(const options::RunOptions& options, const measure::SceneTask& task,
                       const measure::SceneMeasurement& measured, const measure::SceneTruth& truth,
                       const records::GlRecord& gl) {
  images::Grid grid;
  grid.title =
      task.scene->title.empty() ? task.scene->name : fmt::format("{}: {}", task.scene->name, task.scene->title);
  grid.subtitle =
      records::describe_settings(measured.cells.front().record) + " · times: " + records::describe_clock(gl);
  const std::string coverage = records::describe_coverage(measured.cells.front().record.coverage);
  if (!coverage.empty()) grid.subtitle += " · " + coverage;
  grid.tiles = make_truth_tiles(task, truth);
  for (const measure::MeasuredCell& cell : measured.cells) {
    grid.tiles.push_back({cell.label, caption(cell.record, gl), cell.picture, cell.visibility,
                          measure::make_error_image(cell.visibility, truth), cell.record.message,
                          images::make_attribution_bar(cell.record)});
    grid.tiles.back().attribution_words = grid.tiles.back().attribution
                                              ? records::describe_shares(*records::list_shares(cell.record))
                                              : "no attribution: " + records::explain_no_attribution(cell.record);
  }
  grid.error_scale = choose_error_scale(grid.tiles, measured.cells);
  grid.columns = truth.absent.empty() ? 4 : 3;
  grid.crop = choose_crop(measured.cells, images::choose_crop_size({options.width, options.height}));
  return grid;
}

/// Turns values of the view's pixels into an image of one channel.
template <class T>
images::Image make_image(const measure::SceneTruth& truth, const std::vector<T>& values) {
  images::Image image(truth.area.width, truth.area.height, 1);
  std::copy(values.begin(), values.end(), image.texels.begin());
  return image;
}

/// Adds an image of visibility, or of a linear picture, unless it is empty.
void add_part(std::vector<images::Part>& parts, const std::string& name, const images::Image& image) {
  if (image.empty()) return;
  const bool is_picture = image.channels == 3;
  const std::vector<std::string> channels =
      is_picture ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
  parts.push_back({name, channels, image, is_picture});
}

/// Where every pixel's surface is, metres, and its geometric normal: what filters and truth share.
void add_receiver_parts(std::vector<images::Part>& parts, const truth::ReceiverImage& receivers) {
  images::Image position(receivers.width, receivers.height, 3), normal = position;
  for (std::size_t i = 0; i < receivers.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      position.texels[3 * i + static_cast<std::size_t>(axis)] = receivers.points[i].position_ws[axis];
      normal.texels[3 * i + static_cast<std::size_t>(axis)] = receivers.points[i].normal_ws[axis];
    }
  }
  parts.push_back({"receiver.position", {"X", "Y", "Z"}, std::move(position), false});
  parts.push_back({"receiver.normal", {"X", "Y", "Z"}, std::move(normal), false});
}

/// The truth, how sure it is, and which pixels count for what.
void add_truth_parts(std::vector<images::Part>& parts, const measure::SceneTruth& truth,
                     const std::optional<metrics::ArtefactMasks>& masks) {
  add_part(parts, "truth.hard", truth.hard);
  add_part(parts, kTruthPart, truth.area);
  add_part(parts, "truth.ratio", truth.ratio);
  add_part(parts, "truth.standard_error", make_image(truth, truth.standard_errors));
  add_part(parts, kTruthMaskPart, make_image(truth, truth.mask));
  add_part(parts, kTruthPicturePart, truth.area_picture);
  add_receiver_parts(parts, truth.receivers.image);
  if (!masks) return;
  add_part(parts, "truth.mask.acne", make_image(truth, masks->acne));
  add_part(parts, "truth.mask.leak", make_image(truth, masks->leak));
  add_part(parts, "truth.mask.contact_gap", make_image(truth, masks->contact_gap));
}

/// Calls `visit(name, image)` for what a filter draws, and the parts of its error; `Cell` is const where images are
/// read only. A worker hands its visibility without bias to the run, too.
template <class Cell, class Visit>
void visit_drawn(Cell& cell, bool is_worker, const Visit& visit) {
  visit(cell.label + ".visibility", cell.visibility);
  visit(picture_part(cell.label), cell.picture);
  if (is_worker) visit(cell.label + ".unbiased", cell.unbiased);
  for (std::size_t p = 0; p < cell.error_parts.size(); ++p)
    visit(error_part(cell.label, records::list_error_parts()[p]), cell.error_parts[p]);
}

/// The same for what else is known of its pixels. A worker hands its phases to the run that scores them; nobody else
/// has them still.
template <class Cell, class Visit>
void visit_known(Cell& cell, const Visit& visit) {
  for (const images::StabilityImage& each : images::list_stability_images())
    visit(fmt::format("{}.stability.{}", cell.label, each.id), cell.stability.*each.image);
  for (const images::UncertaintyImage& each : images::list_uncertainty_images())
    visit(fmt::format("{}.{}", cell.label, each.id), cell.uncertainty.*each.image);
  for (std::size_t i = 0; i < cell.phases.size(); ++i) visit(fmt::format("{}.phase.{}", cell.label, i), cell.phases[i]);
}

/// What is only looked at takes less room in steps: 255 of FLIP, and as many of a part of the error as 16 bits hold.
images::Image round_values(images::Image image, float steps) {
  for (float& value : image.texels) value = std::round(steps * value) / steps;
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
      planes.emplace_back(records::list_error_parts()[p].id, round_values(cell.error_parts[p], 32767.0f));
  if (!cell.flip.empty()) planes.emplace_back("flip", round_values(cell.flip, 255.0f));
  for (const images::StabilityImage& each : images::list_stability_images())
    if (const images::Image& image = cell.stability.*each.image; image.texels.size() == cell.visibility.texels.size())
      planes.emplace_back(fmt::format("stability.{}", each.id), round_significant(image));
  if (!cell.uncertainty.rounding.empty()) planes.emplace_back("rounding", round_significant(cell.uncertainty.rounding));
  return planes;
}

/// Writes a cell's own pictures; no two labels share a file.
void write_cell_pictures(const options::RunOptions& options, const std::string& stem, measure::MeasuredCell& cell) {
  if (cell.picture.empty()) return;
  const std::string base = "images/" + stem + "." + files::make_file_stem(cell.label);
  cell.record.images.picture = base + ".picture.png";
  cell.record.images.visibility = base + ".visibility.png";
  cell.record.images.values = base + ".values.js";
  images::write_picture_png(options.out / *cell.record.images.picture, cell.picture);
  images::write_grey_png(options.out / *cell.record.images.visibility, cell.visibility);
  images::write_value_file(options.out / *cell.record.images.values, *cell.record.images.values, list_planes(cell));
}

/// Writes what the page's viewer shows of the truth.
void write_truth_pictures(const options::RunOptions& options, const std::string& stem,
                          measure::SceneMeasurement& measured, const measure::SceneTruth& truth) {
  if (!truth.absent.empty()) return;
  const std::string picture = "images/" + stem + ".truth.area.png", values = "images/" + stem + ".truth.area.values.js";
  images::write_picture_png(options.out / picture, truth.area_picture);
  images::write_value_file(options.out / values, values,
                           {{"area", truth.area},
                            {"hard", truth.hard},
                            {"standard_error", make_image(truth, truth.standard_errors)},
                            {"mask", make_image(truth, truth.mask)}});
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.truth_picture = picture;
    cell.record.images.truth_values = values;
  }
}

/// Writes what is shown of each cell by itself, and of the truth.
void write_shown(const options::RunOptions& options, const std::string& stem, measure::SceneMeasurement& measured,
                 const measure::SceneTruth& truth, const std::function<void(double part)>& on_part) {
  write_truth_pictures(options, stem, measured, truth);
  std::atomic<std::size_t> written = 0;
  tbb::parallel_for_each(measured.cells, [&](measure::MeasuredCell& cell) {
    write_cell_pictures(options, stem, cell);
    on_part(static_cast<double>(++written) / static_cast<double>(measured.cells.size()));
  });
  for (measure::MeasuredCell& cell : measured.cells) measure::write_stability(options, stem, cell);
}

constexpr const char* kConvention =
    "A point p of the world, metres, has (U, V, D, W) = uv_depth_from_world * (p, 1), rows first. u = U / W and v "
    "= V / W where the layer is projective, else U and V; depth is D, 0 near and 1 far. A logarithmic layer has v "
    "= scale * log(W) + offset. A paraboloid has u, v = center + radius * (d.x, d.y) / (1 - d.z) and depth = "
    "(distance - near) / range, where (d, distance) is the direction and length of (U, V, D). Texel (i, j) of the "
    "part depth_map covers u = i / size .. (i + 1) / size and v = 1 - (j + 1) / size .. 1 - j / size; layers stand "
    "side by side, the first on the left. depth_map holds linear depth, 1 where nothing is. A receiver is lit "
    "where its depth less its bias is not more than the map's. Bias: max(constant, slope * (1 - n.l)) + "
    "plane_texels * (|dD/du| + |dD/dv|), the latter two along the receiver's plane for each texel, each at most "
    "max_tangent * t / range; before that, the receiver is moved along its normal by normal_texels * t * sin(n, "
    "l). Here t is the size of a texel at the receiver, metres: texel_m; under a lamp, where texels grow with the "
    "distance, texel_m * W / texel_reference_m; of a warped layer and of a paraboloid 1 / sqrt(|grad u x grad v|), "
    "with u and v in texels.";

std::string write_rows(const glm::mat4& matrix) {
  const glm::mat4 rows = glm::transpose(matrix);
  return fmt::format("{}", fmt::join(std::span(&rows[0][0], 16), " "));
}

std::string describe_shape(const scene::LightFrustum& frustum) {
  const scene::LogCurve& log = frustum.log_curve;
  const scene::Paraboloid& paraboloid = frustum.paraboloid;
  switch (frustum.shape) {
    case scene::MapShape::kPlane: return frustum.projective ? "projective" : "parallel";
    case scene::MapShape::kWarped: return "projective";
    case scene::MapShape::kLogarithmic: return fmt::format("logarithmic scale {} offset {}", log.scale, log.offset);
    case scene::MapShape::kParaboloid:
      return fmt::format("paraboloid center {} {} radius {} near {}", paraboloid.center.x, paraboloid.center.y,
                         paraboloid.radius, frustum.perspective->near_m);
  }
  return {};
}

std::string describe_share(const scene::LightFrustum& frustum) {
  if (const auto* slice = std::get_if<scene::ViewSlice>(&frustum.share))
    return fmt::format("view depths {} {} .. {} {}", slice->fade_in_begin, slice->fade_in_end, slice->fade_out_begin,
                       slice->fade_out_end);
  if (const auto* face = std::get_if<scene::CubeFace>(&frustum.share)) return fmt::format("cube face {}", face->index);
  return frustum.is_layered() ? fmt::format("half {}", frustum.layer) : "all";
}

void describe_layer(images::Metadata& metadata, const scene::LightFrustum& frustum) {
  const std::string name = fmt::format("shadowbench:map.layer{}.", frustum.layer);
  metadata[name + "uv_depth_from_world"] = write_rows(frustum.uv_depth_from_world);
  metadata[name + "shape"] = describe_shape(frustum);
  metadata[name + "share"] = describe_share(frustum);
  metadata[name + "texel_m"] = frustum.texel_size_ws;
  if (frustum.perspective) metadata[name + "texel_reference_m"] = frustum.perspective->beam.reference_m;
  metadata[name + "depth_range_m"] = frustum.depth_range_ws;
}

std::string describe_bias(const render::Bias& bias) {
  return fmt::format("constant {} slope {} plane_texels {} normal_texels {} max_tangent {}{}", bias.constant_depth,
                     bias.slope_depth, bias.plane_texels, bias.normal_offset_texels, bias.max_tangent,
                     bias.receiver_plane ? " receiver_plane" : "");
}

/// What the EXR file of a task says beside its pictures: the run, the camera and the light; for every layer of the map
/// how a point of the world is found in it, and the bias of every filter. With its parts `receiver.position`,
/// `receiver.normal` and `depth_map` a reader can compute a filter again (tests/exr does).
images::Metadata describe_task(const options::RunOptions& options, const measure::SceneTask& task,
                               const measure::SceneMeasurement& measured, const gl::GlInfo& info) {
  const scene::Camera& camera = *task.camera;
  images::Metadata metadata;
  metadata["shadowbench:command"] = fmt::format("{}", fmt::join(options.command, " "));
  metadata["shadowbench:commit"] = build_commit();
  metadata["shadowbench:scene"] = task.scene->name;
  metadata["shadowbench:view"] = camera.name;
  metadata["shadowbench:map_size"] = static_cast<double>(task.map_size);
  metadata["shadowbench:border"] = filters::to_string(options.range.border);
  metadata["shadowbench:far_test"] = options.range.far_test ? "on" : "off";
  metadata["shadowbench:behind_test"] = options.range.behind_test ? "on" : "off";
  metadata["shadowbench:seed"] = static_cast<double>(options.seed);
  metadata["shadowbench:renderer"] = info.renderer;
  metadata["shadowbench:camera_position_ws"] = scene::write_vector(camera.position_ws);
  metadata["shadowbench:camera_forward_ws"] = scene::write_vector(camera.forward_ws);
  for (const auto& [name, value] : scene::light_metadata(task.scene->light)) metadata["shadowbench:" + name] = value;
  if (measured.cells.empty()) return metadata;
  metadata["shadowbench:map.convention"] = kConvention;
  for (const render::LightSetup& layer : measured.cells.front().light) describe_layer(metadata, layer.frustum);
  for (const measure::MeasuredCell& cell : measured.cells)
    for (const render::LightSetup& layer : cell.light)
      metadata[fmt::format("shadowbench:bias.layer{}.{}", layer.frustum.layer, cell.label)] = describe_bias(layer.bias);
  return metadata;
}

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
  return images::find_hardest_edge(visibility, reference, size);
}

std::string task_stem(const options::RunOptions& options, const measure::SceneTask& task) {
  std::string name = task.scene->name;
  if (task.scene->cameras.size() > 1) name += "." + task.camera->name;
  if (options.map_sizes.size() > 1) name += fmt::format(".map{}", task.map_size);
  if (options.fits.size() > 1)
    name += "." + records::make_fit_stem(scene::describe_fit(options.fit), scene::describe_fits(options.fits));
  if (options.sizes.size() > 1) name += fmt::format(".{}x{}", options.width, options.height);
  return files::make_file_stem(name);
}

std::string exr_name(const options::RunOptions& options, const measure::SceneTask& task) {
  return task_stem(options, task) + ".exr";
}

std::string picture_part(const std::string& label) { return label + ".picture"; }

std::string error_part(const std::string& label, const records::ErrorPart& part) {
  return fmt::format("{}.error.{}", label, part.id);
}

void take_float_images(measure::MeasuredCell& cell, std::vector<images::Part>& parts) {
  const auto take = [&](const std::string& name, images::Image& image) {
    if (const auto part = std::ranges::find(parts, name, &images::Part::name); part != parts.end())
      image = std::move(part->image);
  };
  cell.error_parts.resize(records::list_error_parts().size());
  visit_drawn(cell, true, take);
  visit_known(cell, take);
  if (std::ranges::all_of(cell.error_parts, &images::Image::empty)) cell.error_parts.clear();
}

void write_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                        const measure::SceneMeasurement& measured, const measure::SceneTruth& truth,
                        const gl::GlInfo& info) {
  std::vector<images::Part> parts;
  const auto add = [&](const std::string& name, const images::Image& image) { add_part(parts, name, image); };
  for (const measure::MeasuredCell& cell : measured.cells) visit_drawn(cell, options.part.is_worker(), add);
  for (const measure::MeasuredCell& cell : measured.cells) visit_known(cell, add);
  if (truth.absent.empty()) add_truth_parts(parts, truth, measured.masks);
  parts.push_back({"depth_map", {"Z"}, measured.depth_map, false});
  add_part(parts, kAmbientPart, measured.ambient);
  images::write_exr(options.out / exr_name(options, task), parts, describe_task(options, task, measured, info));
}

void note_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                       measure::SceneMeasurement& measured) {
  for (measure::MeasuredCell& cell : measured.cells) {
    cell.record.images.exr = exr_name(options, task);
    cell.record.images.parts = cell.label;
    if (!options.pictures) cell.record.absent["images"] = "the run was made with --no-pictures";
  }
}

void write_single_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                           measure::SceneMeasurement& measured, const measure::SceneTruth& truth) {
  write_shown(options, task_stem(options, task), measured, truth, [](double) {});
  for (measure::MeasuredCell& cell : measured.cells) cell.record.absent["images"] = "the run was made with --no-grids";
}

void write_pictures(const options::RunOptions& options, const measure::SceneTask& task,
                    measure::SceneMeasurement& measured, const measure::SceneTruth& truth, const records::GlRecord& gl,
                    const std::function<void(double part)>& on_part) {
  const std::string stem = task_stem(options, task);
  const std::string grid_name = stem + ".grid.png";
  images::write_grid(options.out / grid_name, make_grid(options, task, measured, truth, gl));
  on_part(0.5);
  write_shown(options, stem, measured, truth, [&](double part) { on_part(0.5 + 0.5 * part); });
  for (measure::MeasuredCell& cell : measured.cells) cell.record.images.grid = grid_name;
}

}  // namespace shadowbench::run
