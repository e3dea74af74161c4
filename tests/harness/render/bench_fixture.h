#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "harness/gl/context/context.h"
#include "harness/gl/survey.h"
#include "harness/options/options.h"
#include "harness/render/bias.h"
#include "harness/render/filter_passes.h"
#include "harness/render/gbuffer.h"
#include "harness/scene/load.h"
#include "tests/filters/filtered.h"
#include "tests/harness/scene/made_scenes.h"

namespace shadowbench::test {

/// What stands between a scene's name and a fit's: "avenue_by_lispsm".
inline constexpr std::string_view kBy = "_by_";

/// What the scene's light is fitted by: cascades are for the deep one, unless its name says another.
inline scene::FitMode fit_of(const scene::Scene& scene) {
  const std::size_t by = scene.name.find(kBy);
  if (by != std::string::npos) return scene::parse_fit_rule(scene.name.substr(by + kBy.size())).mode;
  return scene.name == "avenue" ? scene::FitMode::kCascades : scene::FitMode::kTight;
}

/// One context for all tests of a program, made current: a test before this one may have had one of its own.
inline gl::Context& shared_context() {
  static gl::ContextChoice choice = gl::create_context(gl::Backend::kAuto);
  choice.context->make_current();
  return *choice.context;
}

/// The programs of that context that do not depend on a filter: compiled by the first test that draws with them.
inline render::ShaderLibrary& shared_shaders() {
  shared_context();  // is made first, and so outlives them
  static render::ShaderLibrary shaders(options::find_resources().shaders);
  return shaders;
}

/// A scene drawn with one filter, everything at hand that the harness itself uses.
class Bench {
 public:
  explicit Bench(const scene::Scene& scene, int map_size = 1024, int width = 480, int height = 270,
                 const render::MapSettings& map = {}, double pad_texels = 6.0)
      : scene_(scene),
        geometry_(scene),
        layers_(scene::fit_layers(scene, {.mode = fit_of(scene),
                                          .map_size = map_size,
                                          .pad_texels = pad_texels,
                                          .camera = &scene.cameras.front(),
                                          .aspect = static_cast<double>(width) / height})),
        map_(map_size, map, static_cast<int>(layers_.size())),
        gbuffer_(width, height),
        target_("visibility", GL_R32F, width, height) {
    redraw({});
    gbuffer_.draw(shaders_, geometry_, scene_, scene_.cameras.front());
  }

  /// Sets what lies outside the map, for everything drawn from now on.
  void set_range(const filters::RangeRule& range) {
    range_ = range;
    map_.set_border(range.border);
  }

  /// Sets the frame that is drawn, of those that are accumulated.
  void set_frame(std::uint32_t frame) { frame_ = frame; }

  render::LightLayers light(const filters::FilterRequest& request, const render::BiasRule& rule = {}) const {
    render::LightLayers light;
    for (const scene::LightFrustum& layer : layers_) {
      const render::Bias bias = render::resolve_bias(rule, layer, request.spec, request.values);
      light.push_back(render::make_light_setup(layer, scene_.light, bias, 7, range_));
      light.back().frame = frame_;
    }
    return light;
  }

  /// Draws the map again, with another bias in it.
  void redraw(const render::MapBias& bias) {
    for (const scene::LightFrustum& layer : layers_) map_.draw(shaders_, geometry_, layer, bias);
  }

  /// Gives visibility as the GL wrote it: rows bottom to top, like Receiver::pixel.
  std::vector<float> draw(const filters::FilterRequest& request, const render::BiasRule& rule = {}) {
    render::FilterPasses passes(shaders_, request, map_, light(request, rule));
    return draw(passes);
  }

  std::vector<float> draw(render::FilterPasses& passes) {
    passes.prefilter(map_);
    passes.lookup(gbuffer_, map_, target_);
    std::vector<float> visibility = target_.texture().read_floats(1);
    context_.require_no_gl_errors();
    return visibility;
  }

  /// Of all layers; where these share a pixel, it is there once for each.
  std::vector<filters::Receiver> receivers(const filters::FilterRequest& request, const render::BiasRule& rule = {}) {
    std::vector<filters::Receiver> all;
    for (const render::LightSetup& layer : light(request, rule)) {
      const auto own = render::read_receivers(shaders_, gbuffer_, layer);
      all.insert(all.end(), own.begin(), own.end());
    }
    return all;
  }

  std::size_t index(const filters::Receiver& r) const {
    return static_cast<std::size_t>(r.pixel.y) * static_cast<std::size_t>(gbuffer_.width()) +
           static_cast<std::size_t>(r.pixel.x);
  }

  const scene::Scene& scene() const { return scene_; }
  render::ShaderLibrary& shaders() { return shaders_; }
  render::GBuffer& gbuffer() { return gbuffer_; }
  render::ShadowMap& map() { return map_; }
  const scene::LightFrustum& frustum() const { return layers_.front(); }
  const std::vector<scene::LightFrustum>& layers() const { return layers_; }

 private:
  gl::Context& context_ = shared_context();
  scene::Scene scene_;
  render::ShaderLibrary& shaders_ = shared_shaders();
  render::Geometry geometry_;
  std::vector<scene::LightFrustum> layers_;
  filters::RangeRule range_;
  std::uint32_t frame_ = 0;
  render::ShadowMap map_;
  render::GBuffer gbuffer_;
  render::ImageTarget target_;
};

inline scene::Scene load_builtin(const std::string& name) {
  scene::Scene scene = scene::load(name.substr(0, name.find(kBy)), {.scenes_folder = options::find_resources().scenes});
  scene.name = name;
  return scene;
}

/// A built-in scene drawn with all defaults, kept until another is asked for: the tests of one scene follow each other.
/// Who changes what it draws makes a bench of its own.
inline Bench& keep_bench(const std::string& scene_name, int map_size, int width, int height) {
  struct Kept {
    scene::Scene scene;
    std::array<int, 3> sizes;
    Bench bench{scene, sizes[0], sizes[1], sizes[2]};
  };
  shared_shaders();
  static std::unique_ptr<Kept> kept;
  const std::array sizes{map_size, width, height};
  if (!kept || kept->scene.name != scene_name || kept->sizes != sizes)
    kept.reset(new Kept{load_builtin(scene_name), sizes});
  return kept->bench;
}

inline std::vector<std::string> builtin_scenes() {
  std::vector<std::string> names;
  for (const auto& info : scene::list_scenes(options::find_resources().scenes)) names.push_back(info.name);
  return names;
}

/// With one of each other kind of light.
inline std::vector<std::string> scenes_of_all_lights() {
  std::vector<std::string> names = builtin_scenes();
  names.insert(names.end(), {"lamp", "lantern"});
  return names;
}

/// With cascades, a warped map, one of logarithms and paraboloids, too.
inline std::vector<std::string> scenes_of_all_maps() {
  std::vector<std::string> names = scenes_of_all_lights();
  names.insert(names.end(), {"avenue", "avenue_by_lispsm", "avenue_by_logpsm", "lantern_by_paraboloid"});
  return names;
}

using filters::built_in, filters::request_of;

inline std::vector<std::string> filter_ids() {
  std::vector<std::string> ids;
  for (const auto& spec : built_in().filters()) ids.push_back(spec.id);
  return ids;
}

/// What a parameter's text may call its test.
inline std::string make_test_name(std::string text) {
  for (char& c : text) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return text;
}

/// How precisely this GL computes.
inline filters::GlAccuracy measured_accuracy() {
  shared_context();
  static const filters::GlAccuracy measured = gl::survey_gl();
  return measured;
}

/// Gives what a hardware 2x2 comparison may be off by: the step of its weights, as measured on this GL.
inline double measured_weight_step() { return measured_accuracy().weight_bits >= 22.0 ? 1e-4 : 1.0 / 128.0; }

/// Whether a filter rounds what it averaged to whole numbers. Rounding in single precision may decide about a step of
/// them, and a step of few is seen.
inline bool rounds_to_steps(const filters::FilterSpec& spec) {
  return std::ranges::any_of(
      spec.passes,
      [](const filters::PassSpec& pass) { return pass.is_integer() && pass.steps == filters::PassSteps::kOnce; });
}

}  // namespace shadowbench::test
