#include "harness/run/float_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/text.h"
#include "harness/live/frame_file.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/stability_meter.h"
#include "harness/run/provenance.h"
#include "harness/run/task_images.h"

namespace shadowbench::run {
namespace {

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
  const auto make = [&](const auto& values) { return images::make_image(truth.area.width, truth.area.height, values); };
  add_part(parts, "truth.hard", truth.hard);
  add_part(parts, kTruthPart, truth.area);
  add_part(parts, "truth.ratio", truth.ratio);
  add_part(parts, "truth.standard_error", make(truth.standard_errors));
  add_part(parts, kTruthMaskPart, make(truth.mask));
  if (!masks) return;
  add_part(parts, "truth.mask.acne", make(masks->acne));
  add_part(parts, "truth.mask.leak", make(masks->leak));
  add_part(parts, "truth.mask.contact_gap", make(masks->contact_gap));
  add_part(parts, "truth.mask.wide_gap", make(masks->wide_gap));
}

/// How far the first ray towards the light goes; 0 where nothing blocks it.
images::Image make_blocker_image(const measure::SceneTruth& truth) {
  images::Image image(truth.area.width, truth.area.height, 1);
  std::ranges::transform(truth.rays.first_blockers_ws, image.texels.begin(),
                         [](float distance) { return std::isfinite(distance) ? distance : 0.0f; });
  return image;
}

/// What is kept beside visibility and truth.
struct KeptParts {
  bool picture = true;
  bool error = true;
  bool receivers = true;  ///< with the map: what a filter reads
  bool for_run = true;    ///< what a worker hands to the run, without bias and by each cascade
};

/// Most of it takes much room for few readers. All lights at once are added up from pictures.
KeptParts choose_parts(const options::RunOptions& options, const scene::Scene& scene) {
  const bool is_worker = options.part.is_worker(), has_all = options.all_parts || is_worker;
  return {has_all || !scene.light.name.empty(), has_all, options.all_parts && !is_worker, is_worker};
}

/// Calls `visit(name, image)` for what a filter draws, and the parts of its error; `Cell` is const where images are
/// read only.
template <class Cell, class Visit>
void visit_drawn(Cell& cell, const KeptParts& kept, const Visit& visit) {
  visit(cell.label + ".visibility", cell.visibility);
  if (kept.picture) visit(picture_part(cell.label), cell.picture);
  if (kept.for_run) visit(cell.label + ".unbiased", cell.unbiased);
  for (std::size_t i = 0; kept.for_run && i < cell.cascades.size(); ++i)
    visit(fmt::format("{}.cascade.{}", cell.label, i), cell.cascades[i]);
  for (std::size_t p = 0; kept.error && p < cell.error_parts.size(); ++p)
    visit(error_part(cell.label, records::list_error_parts()[p]), cell.error_parts[p]);
}

/// The same for what else is known of its pixels. A worker hands its phases, and what a step of the camera changed, to
/// the run that scores them; nobody else has them still.
template <class Cell, class Visit>
void visit_known(Cell& cell, const Visit& visit) {
  for (const images::StabilityImage& each : images::list_stability_images())
    visit(fmt::format("{}.stability.{}", cell.label, each.id), cell.stability.*each.image);
  for (const images::UncertaintyImage& each : images::list_uncertainty_images())
    visit(fmt::format("{}.{}", cell.label, each.id), cell.uncertainty.*each.image);
  for (std::size_t i = 0; i < cell.phases.size(); ++i) visit(fmt::format("{}.phase.{}", cell.label, i), cell.phases[i]);
  visit(cell.label + ".stepped", cell.stepped);
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
/// `receiver.normal` and `depth_map` (--all-parts) a reader can compute a filter again (tests/exr does).
images::Metadata describe_task(const options::RunOptions& options, const measure::SceneTask& task,
                               const measure::SceneMeasurement& measured, const gl::GlInfo& info) {
  const scene::Camera& camera = *task.camera;
  images::Metadata metadata;
  metadata["shadowbench:command"] = fmt::format("{}", fmt::join(options.command, " "));
  metadata["shadowbench:commit"] = build_commit();
  metadata["shadowbench:scene"] = task.scene->name;
  metadata["shadowbench:view"] = camera.name;
  metadata["shadowbench:map_size"] = static_cast<double>(task.map_size);
  metadata["shadowbench:border"] = std::string(name_of(options.range.border));
  metadata["shadowbench:far_test"] = options.range.far_test ? "on" : "off";
  metadata["shadowbench:behind_test"] = options.range.behind_test ? "on" : "off";
  metadata["shadowbench:seed"] = static_cast<double>(options.seed);
  metadata["shadowbench:renderer"] = info.renderer;
  metadata["shadowbench:camera_position_ws"] = scene::write_vector(camera.position_ws);
  metadata["shadowbench:origin_ws"] = scene::write_vector(glm::vec3(task.scene->origin_ws));
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

/// Texels around those that receivers lie in, which kernels and penumbrae read.
constexpr int kMarginTexels = 64;

/// A rectangle with its rows counted from below, as OpenGL counts them.
images::Rect flip(const images::Rect& rect, int height) {
  return {rect.x, height - rect.y - rect.height, rect.width, rect.height};
}

std::vector<float> cut(const std::vector<float>& texels, int width, int channels, const images::Rect& rect) {
  std::vector<float> part;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    const auto row = texels.begin() + channels * (std::ptrdiff_t{y} * width + rect.x);
    part.insert(part.end(), row, row + std::ptrdiff_t{channels} * rect.width);
  }
  return part;
}

/// The texels of a map of `size` that hold these receivers, as far as they lie in `rect` of the picture, and a margin.
images::Rect find_texels(const std::vector<filters::Receiver>& receivers, const images::Rect& rect, int size) {
  glm::ivec2 low(size), high(-1);
  for (const filters::Receiver& receiver : receivers) {
    const glm::ivec2 within = receiver.pixel - glm::ivec2(rect.x, rect.y);
    if (within.x < 0 || within.y < 0 || within.x >= rect.width || within.y >= rect.height) continue;
    const glm::ivec2 texel(receiver.uv * static_cast<float>(size));
    low = glm::min(low, texel);
    high = glm::max(high, texel);
  }
  if (high.x < low.x) return {};
  low = glm::clamp(low - kMarginTexels, 0, size - 1);
  high = glm::clamp(high + kMarginTexels, low, glm::ivec2(size - 1));
  return {low.x, low.y, high.x + 1 - low.x, high.y + 1 - low.y};
}

live::Check make_check(const measure::TaskRig& rig, const images::Rect& disputed) {
  const render::GBuffer& gbuffer = rig.gbuffer();
  const measure::LightMap& light = rig.light();
  const bool is_whole = rig.renderer.recorder->lacks_vertices();
  const images::Rect rect = is_whole ? images::Rect{0, 0, gbuffer.width(), gbuffer.height()} : disputed;
  live::Check check{rect, {}, is_whole};
  const images::Rect below = flip(rect, gbuffer.height());
  const auto add = [&](const gl::Texture& texture, const std::vector<float>& texels, int channels,
                       const images::Rect& part, float fill) {
    check.known.push_back({rig.renderer.recorder->content_of(texture), part, channels, fill,
                           cut(texels, texture.width(), channels, part)});
  };
  std::vector<const gl::Texture*> receivers = {&gbuffer.position(), &gbuffer.normal()};
  if (is_whole) receivers.insert(receivers.end(), {&gbuffer.shading_normal(), &gbuffer.albedo()});
  for (const gl::Texture* texture : receivers) add(*texture, texture->read_floats(4), 4, below, 0.0f);
  for (const render::LightSetup& layer :
       measure::make_unbiased_light(rig.options, rig.task.scene->light, light.layers)) {
    const int index = layer.frustum.layer;
    const int size = light.map.size();
    const images::Rect part =
        is_whole ? images::Rect{0, 0, size, size}
                 : find_texels(render::read_receivers(rig.renderer.shaders, gbuffer, layer), below, size);
    add(light.map.texture(index), light.map.read(index).stored, 1, part, light.map.settings().curve.far_plane());
  }
  return check;
}

}  // namespace

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
  const auto cascades = std::ranges::count_if(
      parts, [&](const images::Part& part) { return part.name.starts_with(cell.label + ".cascade."); });
  cell.cascades.resize(static_cast<std::size_t>(cascades));
  visit_drawn(cell, {}, take);
  visit_known(cell, take);
  if (std::ranges::all_of(cell.error_parts, &images::Image::empty)) cell.error_parts.clear();
}

void write_float_images(const options::RunOptions& options, const measure::SceneTask& task,
                        const measure::SceneMeasurement& measured, const measure::SceneTruth& truth,
                        const gl::GlInfo& info) {
  std::vector<images::Part> parts;
  const auto add = [&](const std::string& name, const images::Image& image) { add_part(parts, name, image); };
  const KeptParts kept = choose_parts(options, *task.scene);
  for (const measure::MeasuredCell& cell : measured.cells) visit_drawn(cell, kept, add);
  for (const measure::MeasuredCell& cell : measured.cells) visit_known(cell, add);
  if (truth.absent.empty()) add_truth_parts(parts, truth, measured.masks);
  if (kept.receivers) add_receiver_parts(parts, truth.receivers.image);
  if (truth.absent.empty() && kept.receivers) add_part(parts, kBlockerPart, make_blocker_image(truth));
  if (truth.absent.empty() && kept.picture) add_part(parts, kTruthPicturePart, truth.area_picture);
  if (kept.receivers) parts.push_back({"depth_map", {"Z"}, measured.depth_map, false});
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

void write_frames(const measure::TaskRig& rig, measure::SceneMeasurement& measured) {
  std::map<std::string, live::Frame> frames;
  for (measure::MeasuredCell& cell : measured.cells)
    if (cell.frame)
      frames[cell.record.key] = {std::exchange(cell.frame, nullptr), std::exchange(cell.empty_frame, nullptr),
                                 cell.request, cell.light.front().light_size};
  if (frames.empty()) return;
  const images::Size crop{std::max(1, rig.options.width / 4), std::max(1, rig.options.height / 4)};
  const live::Check check = make_check(rig, choose_crop(measured.cells, crop));
  const std::string path = live::write_frames(rig.options.out, frames, check);
  for (measure::MeasuredCell& cell : measured.cells)
    if (frames.contains(cell.record.key)) cell.record.images.frames = path;
}

}  // namespace shadowbench::run
