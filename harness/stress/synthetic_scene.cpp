#include "harness/stress/synthetic_scene.h"

#include <cmath>

#include "harness/stress/filter_stage.h"

namespace shadowbench::stress {
namespace {

constexpr glm::vec3 kFacingLight{0.0f, 0.0f, -1.0f};

class GlLookup final : public SyntheticLookup {
 public:
  GlLookup(const AxisInputs& inputs, const filters::FilterRequest& request)
      : seed_(inputs.seed), stage_(inputs, request) {}

  LookupResult look(const SyntheticScene& scene, const filters::ParamValues& values) override {
    const scene::LightFrustum frustum = scene.frustum.value_or(make_axis_frustum(1.0, scene.size));
    stage_.resize({scene.size, static_cast<int>(scene.receivers.size())});
    stage_.map().upload(scene.depths);
    stage_.upload_receivers(scene.receivers, kFacingLight);
    const std::vector<float> image = stage_.look_up({frustum, 0.0, {}, seed_, {}}, values);
    return {{image.begin(), image.end()}, stage_.count_broken_texels()};
  }

 private:
  std::uint32_t seed_;
  FilterStage stage_;
};

filters::Receiver make_receiver(const SyntheticScene& scene, std::size_t i) {
  filters::Receiver r;
  r.position_ws = scene.receivers[i];
  r.normal_ws = kFacingLight;
  r.uv = {r.position_ws.x, r.position_ws.y};
  r.depth = r.depth_unbiased = r.position_ws.z;
  r.texel_size_ws = 1.0f / static_cast<float>(scene.size);
  r.view_depth = 1.0f;
  r.pixel = {static_cast<int>(i), 0};
  return r;
}

class ModelLookup final : public SyntheticLookup {
 public:
  ModelLookup(const AxisInputs& inputs, filters::FilterRequest request, filters::Precision precision)
      : seed_(inputs.seed),
        request_(std::move(request)),
        model_(filters::make_model(request_.spec)),
        precision_(precision) {}

  LookupResult look(const SyntheticScene& scene, const filters::ParamValues& values) override {
    const filters::DepthMap map{scene.size, scene.depths};
    const filters::ModelInput input{request_.spec, values, map, {}, seed_};
    const auto lookup = model_->prepare(input, precision_);
    LookupResult result;
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

std::vector<float> make_split_depths(int size, float left, float right) {
  std::vector<float> depths(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), right);
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (2 * static_cast<int>(i % static_cast<std::size_t>(size)) < size) depths[i] = left;
  return depths;
}

std::unique_ptr<SyntheticLookup> make_gl_lookup(const AxisInputs& inputs, const filters::FilterRequest& request) {
  return std::make_unique<GlLookup>(inputs, request);
}

std::unique_ptr<SyntheticLookup> make_model_lookup(const AxisInputs& inputs, const filters::FilterRequest& request,
                                                   filters::Precision precision) {
  return std::make_unique<ModelLookup>(inputs, request, precision);
}

double look_at_one_depth(const AxisInputs& inputs, const filters::FilterRequest& request, float stored,
                         float receiver) {
  const int size = 2 * static_cast<int>(std::ceil(filters::radius_texels(request.spec, request.values))) + 6;
  const auto texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  const SyntheticScene scene{size, std::vector<float>(texels, stored), {{0.5f, 0.5f, receiver}}};
  return make_model_lookup(inputs, request, filters::Precision::kDouble)->look(scene, request.values).visibility.at(0);
}

std::shared_ptr<SyntheticLookup> make_lookup(const AxisInputs& inputs, const filters::FilterRequest& request,
                                             Level level) {
  if (level == Level::kGl) return make_gl_lookup(inputs, request);
  return make_model_lookup(inputs, request);
}

}  // namespace shadowbench::stress
