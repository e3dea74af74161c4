// What every filter must do, whatever it is; a user's file keeps the same contract.

// What filters of the kind `bound` promise: more light than percentage-closer filtering with their kernel, or as much.

// What every linear kernel does to a straight edge and to a corner, one texel further and in the mirror: filters of the
// kind `comparison` exactly, those of the kind `stochastic` in the mean over seeds.

#include <cstring>
#include <numeric>

#include "filters/percentage_closer.h"
#include "tests/harness/render/contract_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

using filters::FilterKind;
using filters::FilterRequest;

/// A floor, seen from above; `roof` hangs over all of it where asked for.
scene::Scene floor_scene(bool roof) {
  std::vector<scene::Mesh> meshes = {scene::make_plane({4.0f, 4.0f}, 8)};
  if (roof) meshes.push_back(scene::move_mesh(scene::make_plane({6.0f, 6.0f}, 8), {0.0, 3.0, 0.0}));
  return scene::make_scene_of(meshes, scene::Sun{glm::normalize(glm::vec3(-0.1f, -1.0f, 0.05f))},
                              {scene::make_camera({0.0f, 2.0f, 0.5f}, {0.0f, -2.0f, -0.5f}, {0.0f, 0.0f, -1.0f})});
}

class Contract : public ::testing::TestWithParam<std::string> {};

/// Counts what no visibility can be: NaN, infinite, negative, over 1.
std::ptrdiff_t count_impossible(const std::vector<float>& image) {
  return std::ranges::count_if(
      image, [](float v) { return !(v >= 0.0f && v <= 1.0f); });
}

TEST_P(Contract, VisibilityIsWithinZeroAndOne) {
  Bench bench(load_builtin("stack"), 512, 320, 180);
  EXPECT_EQ(count_impossible(bench.draw(find_filter(GetParam()))), 0);
}

void expect_everywhere(const std::string& filter, const scene::Scene& scene, float visibility, float slack) {
  Bench bench(scene, 256, 160, 90);
  const FilterRequest request = find_filter(filter);
  const std::vector<float> image = bench.draw(request);
  const auto receivers = bench.receivers(request);
  ASSERT_GT(receivers.size(), 1000u);
  for (const auto& r : receivers)
    ASSERT_NEAR(image[bench.index(r)], visibility, slack) << r.pixel.x << "," << r.pixel.y;
}

TEST_P(Contract, NoOccluder_IsLit) { expect_everywhere(GetParam(), floor_scene(false), 1.0f, 1e-4f); }

/// Of all kinds but `other`, which may do what they like under a blocker.
class Blocker : public ::testing::TestWithParam<std::string> {};

TEST_P(Blocker, OfTheWholeFloor_IsDark) { expect_everywhere(GetParam(), floor_scene(true), 0.0f, 1e-3f); }

INSTANTIATE_TEST_SUITE_P(
    AllFilters, Blocker,
    ::testing::ValuesIn(ids_of({FilterKind::kComparison, FilterKind::kStochastic, FilterKind::kBound})), name_of);

TEST_P(Contract, SameInput_SameBits) {
  const scene::Scene scene = load_builtin("cubes");
  Bench first(scene, 256, 160, 90), second(scene, 256, 160, 90);
  const std::vector<float> a = first.draw(find_filter(GetParam())), b = second.draw(find_filter(GetParam()));
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

/// Numbers that are no depths harm the receivers whose kernel holds them, and no others: in the GL, which may clamp
/// what is uploaded, and in the model, which does not.
TEST_P(Contract, PoisonedTexels_HarmNothingBeyondTheKernel) {
  constexpr int kMap = 256;
  Bench bench(load_builtin("cubes"), kMap, 160, 90);
  const FilterRequest request = find_filter(GetParam());
  const filters::ScalarModel* model = filters::find_model(request.spec);
  const auto receivers = bench.receivers(request);
  const auto look = [&](filters::DepthMap map) {
    bench.map().upload(map.stored);
    const std::vector<float> image = bench.draw(request);
    const auto modelled =
        model ? model->prepare({request.spec, request.values, map, {}, 7}, filters::Precision::kFloat) : nullptr;
    std::vector<double> seen;
    for (const auto& r : receivers) {
      seen.push_back(static_cast<double>(image[bench.index(r)]));
      if (modelled) seen.push_back(modelled->at(r).visibility);
    }
    return seen;
  };
  filters::DepthMap map = bench.map().read();
  const std::vector<double> healthy = look(map);
  std::vector<glm::vec2> poisoned;
  for (const float poison : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                             -std::numeric_limits<float>::infinity()}) {
    const int texel = kMap * 128 + 100 + 20 * static_cast<int>(poisoned.size());
    map.stored[static_cast<std::size_t>(texel)] = poison;
    poisoned.emplace_back(texel % kMap, texel / kMap);
  }
  const std::vector<double> harmed = look(map);
  const double reach = filters::radius_texels(request.spec, request.values) + 1.0;
  for (std::size_t i = 0; i < harmed.size(); ++i) {
    const filters::Receiver& r = receivers[i * receivers.size() / harmed.size()];
    const auto holds = [&](const glm::vec2& texel) {
      const glm::vec2 away = glm::abs(r.uv * float{kMap} - 0.5f - texel);
      return static_cast<double>(std::max(away.x, away.y)) <= reach;
    };
    if (std::ranges::none_of(poisoned, holds)) ASSERT_NEAR(harmed[i], healthy[i], 1e-6) << r.uv.x << "," << r.uv.y;
  }
}

/// Gives what a parameter may be driven to: the ends of its range, and all of its choices.
std::vector<filters::ParamValue> extreme_values(const filters::ParamSpec& param) {
  if (std::holds_alternative<bool>(param.default_value)) return {false, true};
  std::vector<filters::ParamValue> values = param.choices;
  if (param.min) values.push_back(*param.min);
  if (param.max) values.push_back(*param.max);
  return values;
}

/// Every parameter at each of its extremes, the others at their defaults; then all at their first, all at their last.
std::vector<std::string> extreme_requests(const filters::FilterSpec& spec) {
  std::vector<std::string> texts;
  std::string first = spec.id, last = spec.id;
  for (const filters::ParamSpec& param : spec.params) {
    const std::vector<filters::ParamValue> values = extreme_values(param);
    for (const auto& value : values) texts.push_back(spec.id + ":" + param.name + "=" + filters::to_string(value));
    if (values.empty()) continue;
    const std::string name = (first == spec.id ? ":" : ",") + param.name + "=";
    first += name + filters::to_string(values.front());
    last += name + filters::to_string(values.back());
  }
  texts.insert(texts.end(), {first, last});
  return texts;
}

TEST_P(Contract, ExtremeParameters_GiveVisibility) {
  Bench bench(load_builtin("cubes"), 64, 64, 36);
  for (const std::string& text : extreme_requests(all_filters().find(GetParam()))) {
    SCOPED_TRACE(text);
    EXPECT_NO_THROW(EXPECT_EQ(count_impossible(bench.draw(find_filter(text))), 0));
  }
}

TEST_P(Contract, ReadsAreCounted_AndWithinTheDeclaredReach) {
  Bench bench(load_builtin("cubes"), 64, 64, 36);
  const FilterRequest request = find_filter(GetParam());
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const render::FilterCost cost = passes.measure_cost(bench.gbuffer(), bench.map());
  EXPECT_EQ(cost.fetches.has_value(), !request.spec.uses_samplers);
  EXPECT_GE(cost.fetches.value_or(1.0), 1.0);
  EXPECT_LE(cost.reach_texels.value_or(0.0), filters::reach_texels(request.spec, request.values) + 1e-3);
  EXPECT_EQ(cost.passes, 2 + passes.prefilter_passes());
  if (request.spec.passes.empty()) EXPECT_EQ(cost.passes, request.spec.has_encode ? 5 : 2);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, Contract, ::testing::ValuesIn(ids_of()), name_of);

double fetches_of(const std::string& text) {
  Bench bench(load_builtin("cubes"), 64, 64, 36);
  const FilterRequest request = find_filter(text);
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  return *passes.measure_cost(bench.gbuffer(), bench.map()).fetches;
}

TEST(FetchCount, EqualsTheFetchesInTheGlsl) {
  EXPECT_DOUBLE_EQ(fetches_of("none"), 1.0);
  EXPECT_DOUBLE_EQ(fetches_of("box3x3"), 9.0);
  EXPECT_DOUBLE_EQ(fetches_of("tent3x3"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("teach4x4"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("box4x4"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("tent4x4"), 4.0);
  EXPECT_DOUBLE_EQ(fetches_of("tent5x5"), 9.0);
  EXPECT_DOUBLE_EQ(fetches_of("castano7"), 16.0);
  EXPECT_DOUBLE_EQ(fetches_of("gather_pcf:radius=3"), 16.0);
  EXPECT_DOUBLE_EQ(fetches_of("poisson:taps=32"), 32.0);
  EXPECT_DOUBLE_EQ(fetches_of("nine_compares"), 9.0);
  EXPECT_DOUBLE_EQ(fetches_of("vsm"), 1.0);
}

/// With every way to store depth, and with the receiver plane's depth in comparisons.
TEST(Gathers, AreTheFourTexelsOfAFetch) {
  const scene::Scene scene = load_builtin("fence");
  filters::Catalogue filters(options::find_resources().filters);
  filters.add_user_file(std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/user_filters/gathers.glsl");
  const FilterRequest request = filters.parse_requests("gathers").front();
  for (const filters::DepthCurve& curve :
       {filters::DepthCurve{}, filters::DepthCurve{true, 1.0}, filters::DepthCurve{true, 100.0}}) {
    for (const char* bias : {"none", "receiver-plane"}) {
      Bench bench(scene, 256, 160, 90, {GL_DEPTH_COMPONENT32F, curve});
      const render::BiasRule rule = render::parse_bias({bias});
      const std::vector<float> image = bench.draw(request, rule);
      int differing = 0;
      for (const auto& r : bench.receivers(request, rule)) differing += image[bench.index(r)] != 1.0f;
      EXPECT_EQ(differing, 0) << bias << " " << render::describe_map(bench.map().settings());
    }
  }
}

TEST(Prefilter, WithoutEncode_CompilesAndRunsNothing) {
  Bench bench(load_builtin("cubes"), 64, 64, 36);
  const int before = bench.shaders().compiled();
  const FilterRequest request = find_filter("none");
  const render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  EXPECT_EQ(bench.shaders().compiled() - before, 1);
  EXPECT_FALSE(passes.has_prefilter());
}

using filters::Kernel;
using filters::Reconstruction;

/// The largest error that single precision makes of a bound over the depths of these floors, where they keep their
/// defaults: it is what the filters' models are held to as well (model_agreement_gl_test.cpp).
constexpr double kRounding = 2e-3;

/// Gives the kernel that a filter averages with: its model names it; without one it is that of the prefilter that its
/// front matter asks for.
Kernel kernel_of(const FilterRequest& request) {
  if (const auto kernel = filters::find_kernel(request.spec, request.values)) return *kernel;
  const bool nearest = filters::text_or(request.values, "sample", "nearest") == "nearest";
  return Kernel::make_gaussian(filters::prefilter_radius_texels(request.spec, request.values),
                               nearest ? Reconstruction::kNearest : Reconstruction::kBilinear);
}

/// A corner, an edge below it that the corner's shadow crosses, and bars of one texel: up to three depths meet in a
/// kernel.
std::vector<Caster> make_layers() {
  constexpr float kFar = 1e4f;
  return {{glm::vec2(-kFar), {0.0f, 2.0f}, 24.0f},
          {{-kFar, -kFar}, {kFar, -1.0f}, 8.0f},
          {{2.0f, -kFar}, {3.0f, kFar}, 16.0f}};
}

class BoundContract : public ::testing::TestWithParam<std::string> {};

TEST_P(BoundContract, IsNeverDarkerThanPcfOfItsKernel_OnLayers) {
  FilterRequest request = find_filter(GetParam());
  if (!request.spec.bound_at_zero.empty()) request.values[request.spec.bound_at_zero] = 0.0;
  AnalyticFloor floor(filters::radius_texels(request.spec, request.values), make_layers());
  const std::vector<float> image = floor.bench().draw(request);
  const filters::DepthMap map = floor.bench().map().read();
  const filters::PercentageCloser closer(kernel_of(request), map);
  int between = 0;
  double darkest = 0.0;
  for (const filters::Receiver& r : floor.bench().receivers(request)) {
    const double pcf = closer.at(r);
    darkest = std::min(darkest, static_cast<double>(image[floor.bench().index(r)]) - pcf);
    between += pcf > 0.01 && pcf < 0.99 ? 1 : 0;
  }
  EXPECT_GT(between, 500);
  EXPECT_GE(darkest, -kRounding);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, BoundContract, ::testing::ValuesIn(ids_of({filters::FilterKind::kBound})),
                         name_of);

constexpr std::uint32_t kEdgeSeeds = 64;
constexpr float kFar = 1e4f;  // casters are cut at the map's border

enum class Along { kU, kV };

std::uint32_t seeds_of(const FilterRequest& request) { return is_stochastic(request) ? kEdgeSeeds : 1; }

double radius_of(const FilterRequest& request) { return filters::radius_texels(request.spec, request.values); }

/// Turns means into estimates: what chance may do to a stochastic filter, and the steps of the hardware's weights.
std::vector<Estimate> estimate(const FilterRequest& request, const std::vector<MeanInUnitInterval>& means,
                               std::size_t tests) {
  std::vector<Estimate> estimates;
  for (const MeanInUnitInterval& each : means) {
    const double chance = is_stochastic(request) ? each.slack(static_cast<double>(tests)) : 0.0;
    estimates.push_back({each.mean(), measured_weight_step() + chance});
  }
  return estimates;
}

/// A straight edge, dark to light, drawn with every seed.
struct Edge {
  std::size_t side = 0;                    ///< of the images, in pixels
  std::vector<std::vector<float>> images;  ///< columns run across the edge
};

Edge draw_edge(const FilterRequest& request, Along along) {
  const glm::vec2 high = along == Along::kU ? glm::vec2(0.0f, kFar) : glm::vec2(kFar, 0.0f);
  AnalyticFloor floor(radius_of(request), {{glm::vec2(-kFar), high}});
  Edge edge{static_cast<std::size_t>(floor.pixels()), draw_seeds(floor.bench(), request, seeds_of(request))};
  if (along == Along::kU) return edge;
  for (std::vector<float>& image : edge.images) {
    for (std::size_t i = 0; i < image.size(); ++i)
      if (const std::size_t turned = i % edge.side * edge.side + i / edge.side; turned > i)
        std::swap(image[i], image[turned]);
  }
  return edge;
}

/// Gives visibility across an edge, by pixel.
std::vector<Estimate> measure_profile(const FilterRequest& request, Along along) {
  const Edge edge = draw_edge(request, along);
  std::vector<MeanInUnitInterval> across(edge.side);
  for (const std::vector<float>& image : edge.images)
    for (std::size_t i = 0; i < image.size(); ++i) across[i % edge.side].add(static_cast<double>(image[i]));
  return estimate(request, across, 2 * edge.side);
}

/// Gives the lit share of lines across an edge.
Estimate measure_light(const FilterRequest& request, Along along) {
  const Edge edge = draw_edge(request, along);
  MeanInUnitInterval lines;
  for (const std::vector<float>& image : edge.images) {
    for (auto line = image.begin(); line != image.end(); line += static_cast<std::ptrdiff_t>(edge.side)) {
      lines.add(std::accumulate(line, line + static_cast<std::ptrdiff_t>(edge.side), 0.0) /
                static_cast<double>(edge.side));
    }
  }
  return estimate(request, {lines}, 2).front();
}

/// An image in square cells: pixels of filters without chance, texels of stochastic ones, whose pixels say too little.
struct Cells {
  int side = 0;
  int per_texel = 1;
  std::vector<Estimate> values;
  const Estimate& at(int u, int v) const { return values[static_cast<std::size_t>(v * side + u)]; }
};

Cells draw_cells(const FilterRequest& request, const std::vector<Caster>& casters) {
  AnalyticFloor floor(radius_of(request), casters);
  const int pixels = floor.pixels(), cell = is_stochastic(request) ? kPixelsPerTexel : 1, side = pixels / cell;
  std::vector<MeanInUnitInterval> means(static_cast<std::size_t>(side * side));
  for (const std::vector<float>& image : draw_seeds(floor.bench(), request, seeds_of(request))) {
    for (int i = 0; i < pixels * pixels; ++i) {
      means[static_cast<std::size_t>((i / pixels / cell) * side + (i % pixels) / cell)].add(
          static_cast<double>(image[static_cast<std::size_t>(i)]));
    }
  }
  return {side, kPixelsPerTexel / cell, estimate(request, means, 3 * means.size())};
}

/// The corner of a wide caster, and a single blocked texel, whose shadow is the kernel itself.
std::vector<Caster> make_corner() { return {{glm::vec2(-kFar), {1.0f, 2.0f}}, {{2.0f, -3.0f}, {3.0f, -2.0f}}}; }

/// Expects of every cell what another image has elsewhere; `elsewhere` gives that place, or a place that is not there.
void expect_equal(const Cells& seen, const Cells& expected, const std::function<glm::ivec2(int, int)>& elsewhere) {
  int compared = 0, dark = 0, differing = 0;
  double worst = 0.0;
  for (int v = 0; v < seen.side; ++v) {
    for (int u = 0; u < seen.side; ++u) {
      const glm::ivec2 at = elsewhere(u, v);
      if (std::min(at.x, at.y) < 0 || std::max(at.x, at.y) >= seen.side) continue;
      const Estimate &a = seen.at(u, v), &b = expected.at(at.x, at.y);
      const double difference = std::abs(a.mean - b.mean);
      worst = std::max(worst, difference);
      differing += difference > a.slack + b.slack ? 1 : 0;
      dark += a.mean < 0.1 ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_EQ(differing, 0) << "of " << compared << " cells; the largest difference is " << worst;
  EXPECT_GT(dark, compared / 20) << "an image without shadow shows nothing";
}

/// Gives the kernel's positions along an axis, by its model; a filter without one has a symmetric kernel, as
/// filters/kernel.h asks.
std::vector<filters::Kernel::Atom> atoms_of(const FilterRequest& request) {
  const auto kernel = filters::find_kernel(request.spec, request.values);
  return kernel ? kernel->atoms() : std::vector<filters::Kernel::Atom>();
}

/// Gives the mean offset of the kernel along an axis, in texels; 0 for disks.
double kernel_mean(const FilterRequest& request) {
  double mean = 0.0;
  for (const filters::Kernel::Atom& atom : atoms_of(request)) mean += atom.weight * atom.offset;
  return mean;
}

bool is_symmetric(const FilterRequest& request) {
  const std::vector<filters::Kernel::Atom> atoms = atoms_of(request);
  return std::equal(atoms.begin(), atoms.end(), atoms.rbegin(), [](const auto& a, const auto& b) {
    return std::abs(a.offset + b.offset) < 1e-9 && std::abs(a.weight - b.weight) < 1e-9;
  });
}

class LinearKernel : public ::testing::TestWithParam<std::string> {
 protected:
  FilterRequest request() const { return find_filter(GetParam()); }
};

TEST_P(LinearKernel, Edge_IsMonotone_FromDarkToLight) {
  for (const Along along : {Along::kU, Along::kV}) {
    const std::vector<Estimate> profile = measure_profile(request(), along);
    Estimate highest = profile.front();
    double fall = 0.0;
    for (const Estimate& each : profile) {
      fall = std::max(fall, highest.mean - highest.slack - (each.mean + each.slack));
      if (each.mean > highest.mean) highest = each;
    }
    EXPECT_EQ(fall, 0.0) << "visibility falls by that much more than chance and the weights' steps explain";
    EXPECT_LE(profile.front().mean, profile.front().slack);
    EXPECT_GE(profile.back().mean, 1.0 - profile.back().slack);
  }
}

/// A kernel takes as much light from one side of an edge as it gives to the other, but for its own mean offset.
TEST_P(LinearKernel, MeanLight_IsConserved) {
  const double texels = AnalyticFloor::view_texels(radius_of(request()));
  for (const Along along : {Along::kU, Along::kV}) {
    const Estimate lit = measure_light(request(), along);
    EXPECT_NEAR(lit.mean, 0.5 + kernel_mean(request()) / texels, lit.slack) << "of " << texels << " texels";
  }
}

TEST_P(LinearKernel, CasterOneTexelFurther_MovesTheShadowOneTexel) {
  const Cells still = draw_cells(request(), make_corner());
  for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
    std::vector<Caster> moved = make_corner();
    for (Caster& each : moved) {
      each.low += glm::vec2(step);
      each.high += glm::vec2(step);
    }
    const glm::ivec2 back = -step * still.per_texel;
    expect_equal(draw_cells(request(), moved), still, [&](int u, int v) { return glm::ivec2(u, v) + back; });
  }
}

/// Pixels keep off the places where ties are broken to one side (see kPixelsPerTexel). Kernels of an even number of
/// texels weigh their ends by where the receiver lies in its texel, and the mirror turns that, too. So nothing is
/// excepted but kernels that their model says are not symmetric.
TEST_P(LinearKernel, MirroredCaster_GivesTheMirroredImage) {
  if (!is_symmetric(request())) GTEST_SKIP() << "the kernel of its model is not symmetric";
  const Cells straight = draw_cells(request(), make_corner());
  for (const int axis : {0, 1}) {
    std::vector<Caster> mirrored = make_corner();
    for (Caster& each : mirrored) {
      const float low = each.low[axis];
      each.low[axis] = -each.high[axis];
      each.high[axis] = -low;
    }
    const int last = straight.side - 1;
    expect_equal(draw_cells(request(), mirrored), straight,
                 [&](int u, int v) { return axis == 0 ? glm::ivec2(last - u, v) : glm::ivec2(u, last - v); });
  }
}

INSTANTIATE_TEST_SUITE_P(AllFilters, LinearKernel,
                         ::testing::ValuesIn(ids_of({FilterKind::kComparison, FilterKind::kStochastic})), name_of);

}  // namespace
}  // namespace shadowbench::test
