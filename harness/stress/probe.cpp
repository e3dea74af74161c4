#include "harness/stress/probe.h"

#include <optional>

#include "harness/measure/map_limits.h"
#include "harness/render/image_target.h"

namespace shadowbench::stress {
namespace {

/// The map's own space is the world's: (x, y, z) of a receiver are its u, v and depth, bit for bit.
scene::LightFrustum make_frustum(int map_size) {
  scene::LightFrustum frustum;
  frustum.width_ws = 1.0;
  frustum.texel_size_ws = 1.0 / map_size;
  frustum.depth_range_ws = 1.0;
  return frustum;
}

/// Everything of one map size and receiver count.
struct Stage {
  Stage(const render::MapSettings& settings, int size, int receivers)
      : map(size, settings), gbuffer(receivers, 1), target("probed visibility", GL_R32F, receivers, 1) {}
  render::ShadowMap map;
  render::GBuffer gbuffer;
  render::ImageTarget target;
};

void upload(Stage& stage, const ProbeScene& scene) {
  std::vector<float> positions, normals;
  for (const glm::vec3& r : scene.receivers) {
    positions.insert(positions.end(), {r.x, r.y, r.z, 1.0f});  // view depth 1: there is something
    normals.insert(normals.end(), {0.0f, 0.0f, -1.0f, 0.0f});
  }
  stage.map.upload(scene.depths);
  stage.gbuffer.upload(positions, normals);
}

class GlProbe final : public Probe {
 public:
  GlProbe(const StressContext& context, filters::FilterRequest request, const render::MapSettings& map)
      : shaders_(context.renderer->shaders), seed_(context.seed), request_(std::move(request)), settings_(map) {}

  ProbeResult look(const ProbeScene& scene, const filters::ParamValues& values) override {
    const int receivers = static_cast<int>(scene.receivers.size());
    const render::LightSetup light{scene.frustum.value_or(make_frustum(scene.size)), 0.0, {}, seed_, {}};
    const bool same_map = stage_ && stage_->map.size() == scene.size;
    if (!same_map) passes_.reset();
    if (!same_map || stage_->gbuffer.width() != receivers) stage_.emplace(settings_, scene.size, receivers);
    upload(*stage_, scene);
    request_.values = values;
    if (passes_)
      passes_->retune(shaders_, values, light);
    else
      passes_.emplace(shaders_, request_, stage_->map, light);
    passes_->prefilter(stage_->map);
    passes_->lookup(stage_->gbuffer, stage_->map, stage_->target);
    const std::vector<float> image = stage_->target.texture().read_floats(1);
    return {{image.begin(), image.end()}, measure::count_broken_texels(*passes_, stage_->map)};
  }

 private:
  render::ShaderLibrary& shaders_;
  std::uint32_t seed_;
  filters::FilterRequest request_;
  render::MapSettings settings_;
  std::optional<Stage> stage_;
  std::optional<render::FilterPasses> passes_;
};

filters::Receiver make_receiver(const ProbeScene& scene, std::size_t i) {
  filters::Receiver r;
  r.position_ws = scene.receivers[i];
  r.normal_ws = {0.0f, 0.0f, -1.0f};
  r.uv = {r.position_ws.x, r.position_ws.y};
  r.depth = r.depth_unbiased = r.position_ws.z;
  r.texel_size_ws = 1.0f / static_cast<float>(scene.size);
  r.view_depth = 1.0f;
  r.pixel = {static_cast<int>(i), 0};
  return r;
}

class ModelProbe final : public Probe {
 public:
  ModelProbe(const StressContext& context, filters::FilterRequest request, filters::Precision precision)
      : seed_(context.seed),
        request_(std::move(request)),
        model_(filters::make_model(request_.spec.id)),
        precision_(precision) {}

  ProbeResult look(const ProbeScene& scene, const filters::ParamValues& values) override {
    const filters::DepthMap map{scene.size, scene.depths};
    const filters::ModelInput input{request_.spec, values, map, {}, seed_};
    const auto lookup = model_->prepare(input, precision_);
    ProbeResult result;
    for (std::size_t i = 0; i < scene.receivers.size(); ++i)
      result.visibility.push_back(lookup->at(make_receiver(scene, i)).visibility);
    return result;
  }

 private:
  std::uint32_t seed_;
  filters::FilterRequest request_;
  std::unique_ptr<filters::Model> model_;
  filters::Precision precision_;
};

}  // namespace

std::unique_ptr<Probe> make_gl_probe(const StressContext& context, const filters::FilterRequest& request,
                                     const render::MapSettings& map) {
  return std::make_unique<GlProbe>(context, request, map);
}

std::unique_ptr<Probe> make_model_probe(const StressContext& context, const filters::FilterRequest& request,
                                        filters::Precision precision) {
  return std::make_unique<ModelProbe>(context, request, precision);
}

ProbeChoice make_probe(const StressContext& context, const filters::FilterRequest& request, Level level) {
  if (level == Level::kGl) {
    if (!context.renderer) return {nullptr, "there is no GL"};
    return {make_gl_probe(context, request), {}};
  }
  if (!filters::make_model(request.spec.id)) return {nullptr, "the filter has no scalar model"};
  return {make_model_probe(context, request), {}};
}

}  // namespace shadowbench::stress
