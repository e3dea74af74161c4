#include "harness/run/exr_metadata.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

#include "harness/run/provenance.h"

namespace shadowbench::run {
namespace {

constexpr const char* kConvention =
    "A point p of the world, metres, has (U, V, D, W) = uv_depth_from_world * (p, 1), rows first. u = U / W and v = V "
    "/ "
    "W where the layer is projective, else U and V; depth is D, 0 near and 1 far. A logarithmic layer has v = scale * "
    "log(W) + offset. A paraboloid has u, v = center + radius * (d.x, d.y) / (1 - d.z) and depth = (distance - near) / "
    "range, where (d, distance) is the direction and length of (U, V, D). Texel (i, j) of the part depth_map covers u "
    "= i / size .. (i + 1) / size and v = 1 - (j + 1) / size .. 1 - j / size; layers stand side by side, the first on "
    "the left. depth_map holds linear depth, 1 where nothing is. A receiver is lit where its depth less its bias is "
    "not more than the map's. Bias: max(constant, slope * (1 - n.l)) + plane_texels * (|dD/du| + |dD/dv|), the latter "
    "two along the receiver's plane for each texel, at most max_tangent * texel / range; before that, the receiver is "
    "moved along its normal by normal_texels * texel * sin(n, l).";

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
  metadata[name + "depth_range_m"] = frustum.depth_range_ws;
}

std::string describe_bias(const render::Bias& bias) {
  return fmt::format("constant {} slope {} plane_texels {} normal_texels {} max_tangent {}{}", bias.constant_depth,
                     bias.slope_depth, bias.plane_texels, bias.normal_offset_texels, bias.max_tangent,
                     bias.receiver_plane ? " receiver_plane" : "");
}

}  // namespace

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

}  // namespace shadowbench::run
