#include "harness/run/scene_truth.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "harness/render/image_target.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/flip.h"
#include "reference/truth/visibility.h"

namespace shadowbench::run {
namespace {

std::vector<reference::OccluderMesh> list_occluders(const scene::Scene& scene) {
  std::vector<reference::OccluderMesh> meshes;
  for (const scene::Mesh& mesh : scene.meshes) {
    if (!mesh.casts_shadow) continue;
    reference::OccluderMesh occluder;
    for (const scene::Vertex& vertex : mesh.vertices) occluder.positions.push_back(vertex.position_ws);
    occluder.indices = mesh.indices;
    meshes.push_back(std::move(occluder));
  }
  return meshes;
}

bool has_cut_out_casters(const scene::Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const scene::Mesh& mesh) {
    return mesh.casts_shadow &&
           scene.materials[static_cast<std::size_t>(mesh.material)].alpha_mode == scene::AlphaMode::kMask;
  });
}

/// The pixels of a view, rows top to bottom.
struct ViewReceivers {
  reference::ReceiverImage image;
  std::vector<std::uint8_t> is_surface;  ///< 0: background
};

ViewReceivers list_receivers(const render::GBuffer& gbuffer, const glm::vec3& to_light) {
  const report::Image positions = render::read_image(gbuffer.position(), 4);
  const report::Image normals = render::read_image(gbuffer.normal(), 4);
  ViewReceivers receivers{{gbuffer.width(), gbuffer.height(), {}}, {}};
  for (std::size_t i = 0; i < positions.texels.size(); i += 4) {
    const float* p = &positions.texels[i];
    const float* n = &normals.texels[i];
    const glm::vec3 normal(n[0], n[1], n[2]);
    const bool is_surface = p[3] != 0.0f;
    receivers.is_surface.push_back(is_surface ? 1 : 0);
    receivers.image.points.push_back({{p[0], p[1], p[2]}, normal, is_surface && glm::dot(normal, to_light) > 0.0f});
  }
  return receivers;
}

/// As in the lookup pass: a surface turned away from the light is dark, the background is lit.
report::Image to_image(const ViewReceivers& receivers, const std::vector<float>& visibility) {
  report::Image image(receivers.image.width, receivers.image.height, 1);
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    const bool counts = receivers.image.points[i].counts;
    image.texels[i] = counts ? visibility[i] : receivers.is_surface[i] ? 0.0f : 1.0f;
  }
  return image;
}

void summarise_errors(SceneTruth& truth, const reference::TracedVisibility& area) {
  double squares = 0.0, unanimous = 0.0, count = 0.0;
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    if (!truth.mask[i]) continue;
    squares += static_cast<double>(area.standard_error[i]) * static_cast<double>(area.standard_error[i]);
    unanimous += area.unanimous[i];
    count += 1.0;
  }
  truth.standard_error = std::sqrt(squares / count);
  truth.unanimous = unanimous / count;
}

/// A display shows 0 to 1.
reference::LinearPicture to_picture(const report::Image& image) {
  reference::LinearPicture picture{image.width, image.height, {}};
  for (std::size_t i = 0; i + 2 < image.texels.size(); i += 3) {
    picture.pixels.push_back(glm::clamp(glm::vec3(image.texels[i], image.texels[i + 1], image.texels[i + 2]), 0.0f, 1.0f));
  }
  return picture;
}

/// Gives nothing where a pixel is not finite: it would spread over its neighbours.
std::optional<double> mean_flip(const report::Image& picture, const report::Image& truth) {
  const auto is_finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(picture.texels.begin(), picture.texels.end(), is_finite)) return std::nullopt;
  const std::vector<float> flip = reference::measure_flip(to_picture(picture), to_picture(truth));
  return std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
}

}  // namespace

SceneTruth trace_scene(const scene::Scene& scene, const render::GBuffer& gbuffer, std::uint32_t seed) {
  SceneTruth truth;
  if (has_cut_out_casters(scene)) {
    truth.absent = "the scene has cut-out casters, which are not traced yet";
    return truth;
  }
  const glm::vec3 to_light = -scene.light.direction_ws;
  const ViewReceivers receivers = list_receivers(gbuffer, to_light);
  for (const reference::ReceiverPoint& point : receivers.image.points) truth.mask.push_back(point.counts ? 1 : 0);
  if (std::find(truth.mask.begin(), truth.mask.end(), 1) == truth.mask.end()) {
    truth.absent = "no surface in view faces the light";
    return truth;
  }
  const reference::Occluders occluders(list_occluders(scene));
  const auto light = reference::AreaLight::make_sun(glm::dvec3(to_light), static_cast<double>(scene.light.angular_diameter_deg));
  truth.hard = to_image(receivers, reference::trace_hard(occluders, receivers.image, light));
  reference::TraceSettings settings;
  settings.seed = seed;
  const reference::TracedVisibility area = reference::trace_area(occluders, receivers.image, light, settings);
  truth.area = to_image(receivers, area.visibility);
  summarise_errors(truth, area);
  return truth;
}

report::Image make_error_image(const report::Image& visibility, const SceneTruth& truth) {
  if (!truth.absent.empty() || visibility.empty()) return {};
  report::Image error(visibility.width, visibility.height, 1);
  for (std::size_t i = 0; i < error.texels.size(); ++i) {
    if (truth.mask[i]) error.texels[i] = visibility.texels[i] - truth.area.texels[i];
  }
  return error;
}

void score(report::CellRecord& record, const report::Image& visibility, const report::Image& picture,
           const SceneTruth& truth) {
  for (const char* group : {"artefact", "attribution"}) record.absent[group] = "not measured in this version";
  const auto stats = truth.absent.empty() && !visibility.empty()
                         ? reference::measure_error(visibility.texels, truth.area.texels, truth.mask)
                         : std::nullopt;
  if (!stats) {
    const std::string reason = !truth.absent.empty()  ? truth.absent
                               : visibility.empty() ? record.message
                                                    : "no pixel of the image is finite";
    record.absent["error"] = reason;
    record.absent["truth"] = reason;
    return;
  }
  record.error = {stats->rmse, stats->mae, stats->p95, stats->max, stats->mean, mean_flip(picture, truth.area_picture),
                  std::nullopt};
  if (!record.error.flip) record.absent["error.flip"] = "the picture has pixels that are not finite";
  record.absent["error.kernel_rmse"] = "not measured in this version";
  record.truth = {truth.standard_error, truth.unanimous};
}

}  // namespace shadowbench::run
