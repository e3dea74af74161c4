#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/context/context.h"
#include "harness/gl/survey/survey.h"
#include "harness/options/options.h"
#include "harness/render/bias/bias_rule.h"
#include "harness/render/filter_passes.h"
#include "harness/render/receivers.h"
#include "harness/scene/load.h"

namespace shadowbench::test {

/// A scene drawn with one filter, everything at hand that the harness itself uses.
class Bench {
 public:
  Bench(gl::Context& context, const scene::Scene& scene, int map_size = 1024, int width = 480, int height = 270,
        const render::MapSettings& map = {})
      : context_(context),
        scene_(scene),
        shaders_(options::find_resources().shaders),
        geometry_(scene),
        frustum_(scene::fit_light(scene, scene::FitMode::kTight, map_size, 6.0)),
        map_(map_size, render::fit_settings(map, frustum_)),
        gbuffer_(width, height),
        target_("visibility", GL_R32F, width, height) {
    map_.draw(shaders_, geometry_, frustum_);
    gbuffer_.draw(shaders_, geometry_, scene_, scene_.cameras.front());
  }

  /// Sets what lies outside the map, for everything drawn from now on.
  void set_range(const filters::RangeRule& range) {
    range_ = range;
    map_.set_border(range.border);
  }

  render::LightSetup light(const filters::FilterRequest& request, const render::BiasRule& rule = {}) const {
    const render::Bias bias = render::resolve_bias(rule, frustum_, request.spec, request.values);
    return render::make_light_setup(frustum_, scene_.light, bias, 7, range_);
  }

  /// Draws the map again, with another bias in it.
  void redraw(const render::MapBias& bias) { map_.draw(shaders_, geometry_, frustum_, bias); }

  /// Gives visibility as the GL wrote it: rows bottom to top, like Receiver::pixel.
  std::vector<float> draw(const filters::FilterRequest& request, const render::BiasRule& rule = {}) {
    render::FilterPasses filter(shaders_, request, map_, light(request, rule));
    filter.prefilter(map_);
    filter.lookup(gbuffer_, map_, target_);
    std::vector<float> visibility = target_.texture().read_floats(1);
    context_.require_no_gl_errors();
    return visibility;
  }

  std::vector<filters::Receiver> receivers(const filters::FilterRequest& request, const render::BiasRule& rule = {}) {
    return render::read_receivers(shaders_, gbuffer_, light(request, rule));
  }

  std::size_t index(const filters::Receiver& r) const {
    return static_cast<std::size_t>(r.pixel.y) * static_cast<std::size_t>(gbuffer_.width()) +
           static_cast<std::size_t>(r.pixel.x);
  }

  render::ShaderLibrary& shaders() { return shaders_; }
  render::GBuffer& gbuffer() { return gbuffer_; }
  render::ShadowMap& map() { return map_; }
  const scene::LightFrustum& frustum() const { return frustum_; }

 private:
  gl::Context& context_;
  const scene::Scene& scene_;
  render::ShaderLibrary shaders_;
  render::Geometry geometry_;
  scene::LightFrustum frustum_;
  filters::RangeRule range_;
  render::ShadowMap map_;
  render::GBuffer gbuffer_;
  render::ImageTarget target_;
};

/// One context for all tests of a program.
inline gl::Context& shared_context() {
  static gl::ContextChoice choice = gl::create_context(gl::Backend::kAuto);
  return *choice.context;
}

inline scene::Scene load_builtin(const std::string& name) {
  return scene::load(name, {.scenes_folder = options::find_resources().scenes});
}

inline std::vector<std::string> builtin_scenes() {
  std::vector<std::string> names;
  for (const auto& info : scene::list_scenes(options::find_resources().scenes)) names.push_back(info.name);
  return names;
}

/// With one of each other kind of light.
inline std::vector<std::string> scenes_of_all_lights() {
  std::vector<std::string> names = builtin_scenes();
  names.push_back("lamp");
  return names;
}

inline const filters::Catalogue& catalogue() {
  static const filters::Catalogue filters(options::find_resources().filters);
  return filters;
}

inline std::vector<std::string> filter_ids() {
  std::vector<std::string> ids;
  for (const auto& spec : catalogue().filters()) ids.push_back(spec.id);
  return ids;
}

}  // namespace shadowbench::test
