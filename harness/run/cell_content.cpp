#include "harness/run/cell_content.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "filters/base/content_hash.h"
#include "filters/model.h"
#include "harness/measure/scene_assets.h"
#include "harness/run/provenance.h"

namespace shadowbench::run {
namespace {

void add_options(ContentHash& hash, const options::RunOptions& options) {
  const options::RoundLimits& rounds = options.rounds;
  hash.add(fmt::format("seed {} truth {} attribution {} stability {} uncertainty {} grids {} pad {} rounds {} {} {} {}",
                       options.seed, options.truth, options.attribution, options.stability, options.uncertainty,
                       options.grids, measure::padding_texels(options), rounds.fewest, rounds.most, rounds.precision,
                       rounds.budget_ms));
  // The masks of artefacts reach as far as the widest kernel of the run.
  hash.add(fmt::format("radius {} reference {} border page {}", measure::widest_kernel_texels(options),
                       options.reference.label(), options.border_page));
  hash.add(fmt::format("lights {} phases {}", fmt::join(options.lights, " "), options.phases));
  for (const gpu::Gpu& gpu : options.gpus) {
    hash.add(fmt::format("{} {}", gpu.name, fmt::join(gpu.families, " ")));
    gpu::visit_constants(gpu, [&](const char*, const gpu::Constant& constant) {
      hash.add_values(std::span<const double>(&constant.value, 1));
    });
  }
}

void add_material(ContentHash& hash, const scene::Material& m) {
  hash.add(fmt::format("{} {} {} {} {} {} {}", m.base_color.r, m.base_color.g, m.base_color.b, m.base_color.a,
                       m.base_color_texture, static_cast<int>(m.alpha_mode), m.alpha_cutoff));
}

void add_camera(ContentHash& hash, const scene::Camera& c) {
  hash.add(c.name);
  for (const glm::vec3& v : {c.position_ws, c.forward_ws, c.up_ws}) hash.add(fmt::format("{} {} {}", v.x, v.y, v.z));
  hash.add(fmt::format("{} {}", c.vertical_fov_rad, c.orthographic_height_m));
}

void add_scene(ContentHash& hash, const scene::Scene& scene) {
  for (const scene::Mesh& mesh : scene.meshes) {
    hash.add(fmt::format("mesh {} {} {}", mesh.material, mesh.casts_shadow, mesh.may_cull_front));
    hash.add_values(std::span<const scene::Vertex>(mesh.vertices));
    hash.add_values(std::span<const std::uint32_t>(mesh.indices));
  }
  for (const scene::Material& material : scene.materials) add_material(hash, material);
  for (const scene::Texture& texture : scene.textures) {
    hash.add(fmt::format("texture {} {}", texture.width, texture.height));
    hash.add_values(std::span<const std::uint8_t>(texture.rgba));
  }
  for (const scene::Camera& camera : scene.cameras) add_camera(hash, camera);
  for (const std::string& piece : scene::list_light_content(scene.light)) hash.add(piece);
  hash.add(fmt::format("{} {} {}", scene.background.r, scene.background.g, scene.background.b));
}

}  // namespace

std::string name_scene_content(const options::RunOptions& options, const scene::Scene& scene) {
  ContentHash hash;
  hash.add(build_commit());
  add_options(hash, options);
  add_scene(hash, scene);
  return hash.name();
}

std::string name_cell_content(const std::string& scene_content, const filters::FilterRequest& request) {
  ContentHash hash;
  hash.add(scene_content);
  hash.add(request.spec.body);
  hash.add(fmt::format("{} claims {}", request.user_file, fmt::join(request.spec.claims, " ")));
  hash.add(fmt::format("moments {} exponent {} floor {} bound at zero {}", request.spec.holds_moments,
                       request.spec.exponent, request.spec.variance_floor, request.spec.bound_at_zero));
  const auto kernel = filters::find_kernel(request.spec, request.values);
  hash.add(fmt::format("kernel {} model {}", kernel ? kernel->name() : "", request.spec.copy_of));
  return hash.name();
}

void add_cell(ContentHash& cells, const std::string& key, const std::string& content) {
  cells.add(key);
  cells.add(content);
}

}  // namespace shadowbench::run
