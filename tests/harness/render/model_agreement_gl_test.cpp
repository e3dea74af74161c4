// Every filter's model, run over the map that was read back and on the very receivers that the GPU used, agrees with
// the GL image: these tests are what makes the filters trustworthy.

#include <tuple>

#include "base/text.h"
#include "filters/screen.h"
#include "harness/measure/view_receivers.h"
#include "tests/harness/render/bench_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

struct Agreement {
  std::size_t compared = 0;
  std::size_t excused = 0;
  double worst_float = 0.0;        ///< |GL - float model|
  double worst_double = 0.0;       ///< |GL - double model|
  double worst_bound_ratio = 0.0;  ///< |GL - double model| / propagated bound
  double median_bound = 0.0;
  std::size_t unbounded = 0;  ///< receivers whose bound says nothing: 1 or more
  double shadowed = 0.0;      ///< share of receivers under 0.5: a test on lit pixels alone proves nothing
};

/// Whether it looks up something else than the depth map.
bool stores(const filters::FilterSpec& spec) { return spec.has_encode || !spec.passes.empty(); }

/// What the model makes of a pixel, in single and double precision, all layers of the map together.
struct ModelPixel {
  double single = 1.0;
  double reference = 1.0;
  double bound = 0.0;
  bool excused = false;
};

constexpr double kShareRounding = 0x1p-23;  // of a share, and of the sum

std::map<std::size_t, ModelPixel> model_pixels(Bench& bench, const filters::FilterRequest& request,
                                               const render::BiasRule& rule) {
  const filters::ScalarModel* model = filters::find_model(request.spec);
  const std::vector<filters::Receiver> receivers = bench.receivers(request, rule);
  std::map<std::size_t, ModelPixel> pixels;
  filters::ScreenPicture single_picture(bench.gbuffer().width(), bench.gbuffer().height());
  filters::ScreenPicture tracked_picture = single_picture;
  for (int layer = 0; layer < bench.map().layers(); ++layer) {
    const filters::DepthMap map = bench.map().read(layer);
    const filters::ModelInput input{
        request.spec, request.values, map, measured_accuracy(), 7, rule.receiver_plane ? rule.max_tangent : 0.0};
    const auto in_float = model->prepare(input, filters::Precision::kFloat);
    const auto tracked = model->prepare(input, filters::Precision::kTracked);
    for (const filters::Receiver& r : receivers) {
      if (r.layer != layer) continue;
      const filters::ModelResult single = in_float->at(r), reference = tracked->at(r);
      single_picture.add(r, single);
      tracked_picture.add(r, reference);
      ModelPixel& pixel = pixels[bench.index(r)];
      measure::put_share(pixel.single, r, single.visibility);
      measure::put_share(pixel.reference, r, reference.visibility);
      pixel.bound += static_cast<double>(r.layer_share) * reference.bound;
      if (r.layer_share < 1.0f) pixel.bound += kShareRounding;
      pixel.excused |= single.excused || reference.excused;
    }
  }
  if (filters::list_screens(request.spec, request.values).empty()) return pixels;
  single_picture.filter(*model, request.spec, request.values, filters::Precision::kFloat);
  tracked_picture.filter(*model, request.spec, request.values, filters::Precision::kTracked);
  for (auto& [index, pixel] : pixels) {
    const auto &single = single_picture.pixels()[index].result, &reference = tracked_picture.pixels()[index].result;
    pixel = {single.visibility, reference.visibility, reference.bound, single.excused || reference.excused};
  }
  return pixels;
}

Agreement compare(Bench& bench, const filters::FilterRequest& request, const render::BiasRule& rule = {}) {
  const std::vector<float> image = bench.draw(request, rule);
  Agreement result;
  std::vector<double> bounds;
  for (const auto& [index, pixel] : model_pixels(bench, request, rule)) {
    const double gpu = static_cast<double>(image[index]);
    ++result.compared;
    if (gpu < 0.5) result.shadowed += 1.0;
    if (pixel.excused) {
      ++result.excused;
      continue;
    }
    EXPECT_TRUE(std::isfinite(gpu)) << "pixel " << index;
    if (!(pixel.bound < 1.0)) ++result.unbounded;
    result.worst_float = std::max(result.worst_float, std::abs(gpu - pixel.single));
    result.worst_double = std::max(result.worst_double, std::abs(gpu - pixel.reference));
    if (pixel.bound > 0.0)
      result.worst_bound_ratio = std::max(result.worst_bound_ratio, std::abs(gpu - pixel.reference) / pixel.bound);
    bounds.push_back(pixel.bound);
  }
  std::nth_element(bounds.begin(), bounds.begin() + static_cast<std::ptrdiff_t>(bounds.size() / 2), bounds.end());
  result.median_bound = bounds[bounds.size() / 2];
  result.shadowed /= static_cast<double>(result.compared);
  return result;
}

struct Limits {
  double excused = 0.005;         ///< the share of receivers that may be, but for filters that round to steps
  double worst_of_stored = 2e-3;  ///< |GL - float model| of a filter that looks up something else than the depth map
  double shadowed = 0.01;         ///< the share that must be
};

void expect_agreement(const Agreement& a, const filters::FilterSpec& spec, const Limits& limits) {
  SCOPED_TRACE(spec.id);
  EXPECT_GT(a.shadowed, limits.shadowed);
  EXPECT_LT(static_cast<double>(a.excused),
            (rounds_to_steps(spec) ? 0.08 : limits.excused) * static_cast<double>(a.compared));
  EXPECT_LE(a.worst_float, stores(spec) ? limits.worst_of_stored : measured_weight_step());
  if (stores(spec))
    EXPECT_LE(a.worst_bound_ratio, 1.0);
  else
    EXPECT_LE(a.worst_double, measured_weight_step());
}

class ModelAgreement : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  bool in_half_floats() const {
    return std::ranges::any_of(
        built_in().find(std::get<1>(GetParam())).passes,
        [](const filters::PassSpec& pass) { return pass.store.ends_with("16f"); });
  }
};

TEST_P(ModelAgreement, GlImageEqualsModel) {
  const auto& [scene_name, filter] = GetParam();
  // On coarser texels too many kernels round the lantern are a choice that rounding decides.
  Bench& bench = keep_bench(scene_name, scene_name.starts_with("lantern") ? 1024 : 512, 240, 135);
  const filters::FilterSpec& spec = built_in().find(filter);
  const Agreement a = compare(bench, request_of(filter));
  const bool curved = is_curved(bench.frustum().shape);
  const bool is_even = bench.map().settings().curve.is_linear() && !curved;  // its depth
  EXPECT_GT(a.compared, 5000u);
  // Filters that choose their kernel are excused by that choice, too.
  const double by_choice = fit_of(bench.scene()) == scene::FitMode::kParaboloid ? 0.05 : 0.01;
  expect_agreement(a, spec,
                   {.excused = spec.claims.empty() ? 0.005 : by_choice, .worst_of_stored = curved ? 1e-2 : 2e-3});
  // Across a silhouette the position's rounding alone can exceed the minimum variance, and light-bleeding reduction
  // widens every bound. So does reading depth back from a perspective map, and texels that are small beside the
  // range of depth, as a warped map has them near the camera.
  if (!is_even) return;
  EXPECT_LT(static_cast<double>(a.unbounded), 0.25 * static_cast<double>(a.compared));
  if (stores(spec)) EXPECT_LE(a.median_bound, in_half_floats() ? 0.03 : 0.01) << "a bound this wide says nothing";
}

INSTANTIATE_TEST_SUITE_P(AllFilters, ModelAgreement,
                         ::testing::Combine(::testing::ValuesIn(scenes_of_all_maps()),
                                            ::testing::ValuesIn(filter_ids())),
                         [](const auto& each) { return std::get<0>(each.param) + "_" + std::get<1>(each.param); });

/// Each format, with linear and perspective depth, stored either way round.
using FormatCase = std::tuple<std::string, GLenum, bool, double>;
class ModelFormats : public ::testing::TestWithParam<FormatCase> {};

TEST_P(ModelFormats, GlImageEqualsModel) {
  const auto& [scene_name, format, reversed, ratio] = GetParam();
  Bench bench(load_builtin(scene_name), 512, 160, 90, {format, {reversed, ratio}});
  for (const std::string& id : filter_ids()) {
    const filters::FilterRequest request = request_of(id);
    const Agreement a = compare(bench, request);
    // A depth that is read back one ULP off falls on another step of a summed-area table, alike all over a plane.
    expect_agreement(a, request.spec, {.excused = 0.01, .worst_of_stored = request.spec.passes.empty() ? 2e-3 : 1e-2});
  }
}

std::string name_format_case(const ::testing::TestParamInfo<FormatCase>& each) {
  const auto& [scene, format, reversed, ratio] = each.param;
  return make_test_name(scene + "_" + render::describe_map({format, {reversed, ratio}}));
}

INSTANTIATE_TEST_SUITE_P(AllFormats, ModelFormats,
                         ::testing::Combine(::testing::Values("steps", "fence"),
                                            ::testing::Values(GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24,
                                                              GL_DEPTH_COMPONENT32F),
                                            ::testing::Bool(), ::testing::Values(1.0, 100.0)),
                         name_format_case);

/// A fixed-point map clamps the reference, so that a point beyond the far plane ties with what was cleared.
TEST(FixedPointMap, ReferenceBeyondOne_IsLitInFixedPointAlone_InModelAndGl) {
  const scene::Scene scene = load_builtin("cubes");
  filters::Catalogue filters(options::find_resources().filters);
  filters.add_user_file(std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/user_filters/beyond_far.glsl");
  for (const bool reversed : {false, true}) {
    for (const GLenum format : {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F}) {
      Bench bench(scene, 64, 64, 36, {format, {reversed}});
      const filters::FilterRequest request = filters.parse_requests("beyond_far").front();
      const std::vector<float> image = bench.draw(request);
      const filters::DepthMap map = bench.map().read();
      EXPECT_EQ(map.texel_bytes, format == GL_DEPTH_COMPONENT16 ? 2 : 4);
      const float in_model = map.is_lit(1.5f, map.curve.far_plane()) ? 1.0f : 0.0f;
      const filters::Receiver r = bench.receivers(request).front();
      EXPECT_EQ(image[bench.index(r)], in_model) << render::describe_map({format, {reversed}});
      EXPECT_EQ(in_model, format == GL_DEPTH_COMPONENT32F ? 0.0f : 1.0f);
    }
  }
}

/// Parameters that take another path through a filter, on `stack` or the scene after " on ".
class ModelVariants : public ::testing::TestWithParam<std::string> {};

TEST_P(ModelVariants, GlImageEqualsModel) {
  const std::size_t end = GetParam().find(" on ");
  const filters::FilterRequest request = request_of(GetParam().substr(0, end));
  // In a small picture penumbrae are narrower than a pixel, and a screen pass blurs nothing.
  const int scale = filters::list_screens(request.spec, request.values).empty() ? 1 : 3;
  Bench& bench =
      keep_bench(end == std::string::npos ? "stack" : GetParam().substr(end + 4), 256, scale * 240, scale * 135);
  const Agreement a = compare(bench, request);
  // A screen pass spreads what rounding decides over the pixels around.
  const double excused = filters::list_screens(request.spec, request.values).empty() ? 0.005 : 0.05;
  const bool half = filters::text_or(request.values, "store", "").find("16") != std::string::npos;
  expect_agreement(a, request.spec, {.excused = excused, .worst_of_stored = half ? 1.0 : 2e-3});
}

INSTANTIATE_TEST_SUITE_P(
    Parameters, ModelVariants,
    ::testing::Values(
        "gather_pcf:radius=1", "gather_pcf:radius=3,shape=castano", "pcss:rotation=none,max_radius=2",
        "pcss:rotation=interleaved-gradient,taps=8,search_taps=4", "pcss:max_radius=0", "pcss:read=nearest",
        "pcss:read=nearest,max_radius=0", "pcss:read=interpolated", "pcss:screen=bilateral",
        "pcss:taps=4,search_taps=4,screen=bilateral on ball", "pcss:screen=bilateral on avenue",
        "dpcf:rotation=none,max_radius=2", "dpcf:rotation=interleaved-gradient,taps=8", "dpcf:max_radius=20,taps=32",
        "dpcf:max_radius=0", "poisson:rotation=none", "poisson:rotation=interleaved-gradient,taps=8",
        "poisson:radius=0,taps=4", "evsm2:radius=0", "evsm2:bleed_reduction=0.2", "evsm4:bleed_reduction=0.2",
        "gather_pcf:radius=1,shape=castano", "gather_pcf:shape=castano", "gather_pcf:radius=3", "evsm4:store=rgba16f",
        "evsm4:radius=1,c_down=20", "msm_hamburger:store=rgba16", "msm_hausdorff:store=rgba16,radius=1",
        "msm_hausdorff:radius=1", "poisson:taps=32,radius=6", "vsm:radius=0", "vsm:radius=12",
        "vsm:bleed_reduction=0,slope_variance=0", "vsm:slope_variance=1", "vsm:min_variance=0.001,store=rg16f",
        "esm:radius=0", "esm:c=20", "esm:fallback=percentage-closer", "esm:fallback=percentage-closer,radius=0",
        "esm:fallback=percentage-closer,combine=log,radius=1", "esm:combine=log,c=500", "esm:combine=log,radius=0",
        "esm:c=8,store=r16f", "vsm_sat:radius=0", "vsm_sat:radius=20", "vsm_sat:bleed_reduction=0,slope_variance=0",
        "csm_conv:radius=0,damping=0", "csm_conv:scale=1", "vssm:max_radius=0", "vssm:max_radius=4,bleed_reduction=0",
        "vssm:min_variance=0.001", "evssm:taps=1,rotation=none", "evssm:taps=8,rotation=per-pixel",
        "evssm:max_radius=0", "evssm:max_radius=8,bleed_reduction=0.2,c_down=10", "poisson:bail=agree",
        "poisson:bail=agree,pattern=blue-noise", "poisson:taps=5,rotation=interleaved-gradient", "pcss:bail=agree",
        "pcss:bail=agree on ball", "smrt:rays=1", "smrt:rotation=none,steps=16,thickness=1",
        "smrt:rotation=interleaved-gradient,rays=4,steps=4", "smrt:max_radius=4,thickness=8",
        "msm_packed64:lookup=bilinear", "msm_packed64:radius=1", "msm_packed32:lookup=bilinear",
        "msm_packed32:radius=1", "msm_soft:max_radius=0", "msm_soft:max_radius=4,moment_bias=0.001"),
    [](const auto& each) { return make_test_name(each.param); });

/// Every frame turns the taps of every filter that turns them, in the GL as in its model.
TEST(ModelFrames, GlImageEqualsModel_AndDiffersFromTheFirstFrames) {
  Bench bench(load_builtin("stack"), 256, 160, 90);
  for (const filters::FilterSpec& spec : built_in().filters()) {
    if (spec.kind != filters::FilterKind::kStochastic) continue;
    for (const char* rotation : {"none", "per-pixel", "interleaved-gradient", "blue-noise"}) {
      SCOPED_TRACE(spec.id + ", " + rotation);
      const filters::FilterRequest request = request_of(spec.id + ":rotation=" + rotation);
      bench.set_frame(0);
      const std::vector<float> first = bench.draw(request);
      bench.set_frame(5);
      EXPECT_EQ(bench.draw(request) == first, rotation == std::string("none"));
      EXPECT_LE(compare(bench, request).worst_float, measured_weight_step());
    }
  }
}

/// Filters that compare tap by tap, with the receiver plane's depth at each tap.
class ReceiverPlaneModel : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(ReceiverPlaneModel, GlImageEqualsModel) {
  const auto& [scene_name, filter] = GetParam();
  Bench& bench = keep_bench(scene_name, 256, 240, 135);
  const Agreement a = compare(bench, request_of(filter), render::parse_bias({"receiver-plane"}));
  EXPECT_GT(a.compared, 5000u);
  expect_agreement(a, built_in().find(filter), {});
}

INSTANTIATE_TEST_SUITE_P(Filters, ReceiverPlaneModel,
                         ::testing::Combine(::testing::Values("cubes", "steps"),
                                            ::testing::Values("none", "pcf2x2", "tent3x3", "box3x3", "teach4x4",
                                                              "box4x4", "tent5x5", "castano7", "gather_pcf", "poisson",
                                                              "pcss", "dpcf", "smrt")),
                         [](const auto& each) { return std::get<0>(each.param) + "_" + std::get<1>(each.param); });

/// With the same bias, a ray to the light's centre is a comparison with one texel.
TEST(ShadowMapRayTracing, OneRay_EqualsNoFilter_BitForBit) {
  const render::BiasRule bias = render::parse_bias({"constant:depth=1e-3"});
  for (const char* name : {"ball", "fence", "lantern"}) {
    Bench bench(load_builtin(name), 512, 240, 135);
    const auto draw = [&](const char* text) { return bench.draw(request_of(text), bias); };
    EXPECT_EQ(draw("smrt:rays=1"), draw("none")) << name;
  }
}

/// What lies outside the map, on a scene with many receivers there.
class BorderAgreement : public ::testing::TestWithParam<std::tuple<filters::Border, std::string>> {};

TEST_P(BorderAgreement, GlImageEqualsModel) {
  const auto& [border, filter] = GetParam();
  Bench bench(load_builtin("edge"), 250, 240, 135);  // no power of two: nothing wraps by accident
  bench.set_range({border, false, true});
  const filters::FilterRequest request = request_of(filter);
  const Agreement a = compare(bench, request);
  EXPECT_GT(a.compared, 5000u);
  expect_agreement(a, request.spec, {.excused = 0.02, .shadowed = 0.1});
}

std::vector<std::string> filters_of_borders() {
  std::vector<std::string> requests = filter_ids();
  requests.insert(requests.end(), {"vsm:radius=0", "vsm:radius=20", "esm:combine=log"});
  return requests;
}

INSTANTIATE_TEST_SUITE_P(
    AllFilters, BorderAgreement,
    ::testing::Combine(::testing::Values(filters::Border::kBorder, filters::Border::kEdge, filters::Border::kRepeat),
                       ::testing::ValuesIn(filters_of_borders())),
    [](const auto& each) {
      return make_test_name(std::string(shadowbench::name_of(std::get<0>(each.param))) + "_" + std::get<1>(each.param));
    });

}  // namespace
}  // namespace shadowbench::test
