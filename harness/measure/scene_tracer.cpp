#include "harness/measure/scene_tracer.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/measure/content_hash.h"
#include "reference/truth/version.h"

namespace shadowbench::measure {
namespace {

truth::CutOut make_cut_out(const scene::Scene& scene, const scene::Mesh& mesh, const scene::Material& material) {
  truth::CutOut cut_out;
  for (const scene::Vertex& vertex : mesh.vertices) cut_out.uvs.push_back(vertex.uv);
  cut_out.base_alpha = material.base_color.a;
  cut_out.cutoff = material.alpha_cutoff;
  if (material.base_color_texture < 0) return cut_out;
  const scene::Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
  cut_out.width = texture.width;
  cut_out.height = texture.height;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) cut_out.alpha.push_back(texture.rgba[i]);
  return cut_out;
}

std::vector<truth::OccluderMesh> list_occluders(const scene::Scene& scene) {
  std::vector<truth::OccluderMesh> meshes;
  for (const scene::Mesh& mesh : scene.meshes) {
    if (!mesh.casts_shadow) continue;
    truth::OccluderMesh& occluder = meshes.emplace_back();
    for (const scene::Vertex& vertex : mesh.vertices) occluder.positions.push_back(vertex.position_ws);
    occluder.indices = mesh.indices;
    const scene::Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (material.alpha_mode == scene::AlphaMode::kMask) occluder.cut_out = make_cut_out(scene, mesh, material);
  }
  return meshes;
}

std::string name_geometry(const std::vector<truth::OccluderMesh>& meshes) {
  ContentHash hash;
  hash.add(truth::truth_version());
  hash.add(SHADOWBENCH_TRACER_SOURCES);
  for (const truth::OccluderMesh& mesh : meshes) {
    hash.add_values(std::span<const glm::vec3>(mesh.positions));
    hash.add_values(std::span<const std::uint32_t>(mesh.indices));
    if (!mesh.cut_out) continue;
    const truth::CutOut& holes = *mesh.cut_out;
    hash.add_values(std::span<const glm::vec2>(holes.uvs));
    hash.add(fmt::format("{} {} {} {}", holes.width, holes.height, holes.base_alpha, holes.cutoff));
    hash.add_values(std::span<const std::uint8_t>(holes.alpha));
  }
  return hash.name();
}

truth::MapGrid make_grid(const scene::LightFrustum& frustum) {
  const auto row = [&](int r) {
    const glm::dmat4& m = frustum.light_from_world;
    return glm::dvec3(m[0][r], m[1][r], m[2][r]);
  };
  return {-glm::dvec3(frustum.direction_ws), row(0), row(1), frustum.texel_size_ws};
}

std::string name_grid(const truth::MapGrid& grid) {
  return fmt::format("texel {} right {} {} {} up {} {} {}", grid.texel_size_ws, grid.right.x, grid.right.y,
                     grid.right.z, grid.up.x, grid.up.y, grid.up.z);
}

template <class T>
images::Part make_part(const char* name, const truth::ReceiverImage& size, const std::vector<T>& values) {
  images::Image image(size.width, size.height, 1);
  for (std::size_t i = 0; i < values.size(); ++i) image.texels[i] = static_cast<float>(values[i]);
  return {name, {"Y"}, std::move(image), false};
}

std::vector<images::Part> to_parts(const truth::ReceiverImage& size, const truth::TracedVisibility& traced) {
  return {make_part("visibility", size, traced.visibility), make_part("standard_error", size, traced.standard_error),
          make_part("unanimous", size, traced.unanimous), make_part("rays", size, traced.rays)};
}

const std::vector<std::string> kTracedParts = {"visibility", "standard_error", "unanimous", "rays"};
const std::vector<std::string> kViewParts = {"visibility", "standard_error", "unanimous",
                                             "rays",       "hard",           "first_blockers"};

bool fits(const std::vector<images::Part>& parts, const std::vector<std::string>& names,
          const truth::ReceiverImage& size) {
  return std::equal(
      parts.begin(), parts.end(), names.begin(), names.end(),
      [&](const images::Part& part, const std::string& name) {
        return part.name == name && part.image.width == size.width && part.image.height == size.height &&
               part.image.channels == 1;
      });
}

template <class T>
std::vector<T> convert(const images::Part& part) {
  return {part.image.texels.begin(), part.image.texels.end()};
}

truth::TracedVisibility from_parts(const std::vector<images::Part>& parts) {
  return {parts[0].image.texels, parts[1].image.texels, convert<std::uint8_t>(parts[2]),
          convert<std::uint32_t>(parts[3])};
}

}  // namespace

truth::Occluders make_occluders(const scene::Scene& scene) { return truth::Occluders(list_occluders(scene)); }

SceneTracer::SceneTracer(const scene::Scene& scene, TruthCache& cache, std::uint32_t seed)
    : scene_(scene), cache_(cache), seed_(seed) {}

const std::string& SceneTracer::geometry() {
  if (geometry_.empty()) geometry_ = name_geometry(list_occluders(scene_));
  return geometry_;
}

const truth::Occluders& SceneTracer::occluders() {
  if (!occluders_) occluders_.emplace(make_occluders(scene_));
  return *occluders_;
}

truth::TraceSettings SceneTracer::settings() const {
  truth::TraceSettings settings;
  settings.seed = seed_;
  return settings;
}

std::vector<images::Part> SceneTracer::find_or_trace(const ViewReceivers& receivers, const std::string& what,
                                                     const std::vector<std::string>& part_names,
                                                     const std::function<std::vector<images::Part>()>& trace) {
  ContentHash hash;
  const truth::TraceSettings s = settings();
  for (const std::string& text :
       {geometry(), receivers.content, what, fmt::format("{} {} {}", s.standard_error, s.max_points, s.seed)})
    hash.add(text);
  const std::string name = hash.name();
  const auto is_whole = [&](const std::vector<images::Part>& parts) {
    return fits(parts, part_names, receivers.image);
  };
  if (auto kept = cache_.load(name, is_whole)) return std::move(*kept);
  std::vector<images::Part> parts = trace();
  cache_.store(name, parts);
  return parts;
}

ViewRays SceneTracer::trace_view(const ViewReceivers& receivers) {
  const glm::dvec3 to_light = -glm::dvec3(scene_.light.direction_ws);
  const double diameter = static_cast<double>(scene_.light.angular_diameter_deg);
  const auto parts = find_or_trace(receivers, fmt::format("sun of {} degrees", diameter), kViewParts, [&] {
    const auto light = truth::AreaLight::make_sun(to_light, diameter);
    auto traced = to_parts(receivers.image, truth::trace_area(occluders(), receivers.image, light, settings()));
    traced.push_back(make_part("hard", receivers.image, truth::trace_hard(occluders(), receivers.image, light)));
    traced.push_back(make_part("first_blockers", receivers.image,
                               truth::trace_first_blockers(occluders(), receivers.image, to_light)));
    return traced;
  });
  return {from_parts(parts), parts[4].image.texels, parts[5].image.texels};
}

truth::TracedVisibility SceneTracer::trace_kernel(const ViewReceivers& receivers, const filters::Kernel& kernel,
                                                  const scene::LightFrustum& frustum) {
  const truth::MapGrid grid = make_grid(frustum);
  return from_parts(
      find_or_trace(receivers, fmt::format("kernel {} {}", kernel.name(), name_grid(grid)), kTracedParts, [&] {
        return to_parts(receivers.image, truth::trace_kernel(occluders(), receivers.image, kernel, grid, settings()));
      }));
}

truth::TracedVisibility SceneTracer::trace_surroundings(const ViewReceivers& receivers, double half_width_texels,
                                                        const scene::LightFrustum& frustum) {
  const truth::MapGrid grid = make_grid(frustum);
  return from_parts(
      find_or_trace(receivers, fmt::format("square {} {}", half_width_texels, name_grid(grid)), kTracedParts, [&] {
        truth::TraceSettings rough = settings();
        rough.standard_error = 1.0;
        rough.max_points = 16;  // none is asked for more
        return to_parts(receivers.image,
                        truth::trace_square(occluders(), receivers.image, half_width_texels, grid, rough));
      }));
}

}  // namespace shadowbench::measure
