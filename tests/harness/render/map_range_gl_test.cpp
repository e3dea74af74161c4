#include "harness/measure/view_receivers.h"
#include "reference/truth/visibility.h"
#include "tests/harness/render/contract_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

using filters::Border;
using filters::RangeRule;
using filters::Receiver;
using ::testing::FloatNear;

// Each wrong way to treat what lies outside the map gives its own artefact on the scene made for it; the right way
// none.
// What the GL computes of a receiver in a curved map is what the frustum says in double.

constexpr int kRangeMapSize = 256;
constexpr float kBeyondKernels = 12.0f / kRangeMapSize;  // no default kernel reaches this far from outside into the map

bool is_outside(const Receiver& r) {
  const glm::vec2 from_center = glm::abs(r.uv - 0.5f);
  return std::max(from_center.x, from_center.y) > 0.5f + kBeyondKernels;
}

bool is_beyond_far(const Receiver& r) { return r.depth_unbiased > 1.0f; }

/// The scene `edge` with every receiver known, those beyond the far plane too.
class EdgeScene {
 public:
  EdgeScene() : scene_(load_builtin("edge")), bench_(scene_, kRangeMapSize) {
    bench_.set_range({Border::kBorder, false, true});
    receivers_ = bench_.receivers(request_of("none"));
  }

  /// Gives what a filter draws of the receivers that `belongs` chooses.
  std::vector<float> draw(const std::string& filter, const RangeRule& rule,
                          const std::function<bool(const Receiver&)>& belongs) {
    bench_.set_range(rule);
    const std::vector<float> image = bench_.draw(request_of(filter));
    std::vector<float> seen;
    for (const Receiver& r : receivers_)
      if (belongs(r)) seen.push_back(image[bench_.index(r)]);
    EXPECT_GT(seen.size(), 200u) << "the scene shows none of these receivers";
    return seen;
  }

  /// Gives the share of them that is darker than half lit.
  double dark(const std::string& filter, const RangeRule& rule, const std::function<bool(const Receiver&)>& belongs) {
    const std::vector<float> seen = draw(filter, rule, belongs);
    return static_cast<double>(std::ranges::count_if(seen, [](float v) { return v < 0.5f; })) /
           static_cast<double>(seen.size());
  }

  Bench& bench() { return bench_; }
  std::size_t receivers() const { return receivers_.size(); }

 private:
  scene::Scene scene_;
  Bench bench_;
  std::vector<Receiver> receivers_;
};

bool is_outside_before_far(const Receiver& r) { return is_outside(r) && !is_beyond_far(r); }

/// On the terrace right of the beam, in line with it.
bool is_in_streak(const Receiver& r) {
  return is_outside_before_far(r) && std::abs(r.position_ws.z + 0.3f) < 0.1f && r.position_ws.x > 2.6f;
}

class MapRange : public ::testing::TestWithParam<std::string> {};

TEST_P(MapRange, RightRule_LightsEverythingOutside) {
  EdgeScene edge;
  EXPECT_EQ(edge.dark(GetParam(), {}, is_outside), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_in_streak), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_beyond_far), 0.0);
  EXPECT_THAT(edge.draw(GetParam(), {}, is_outside), Each(FloatNear(1.0f, 1e-3f)));
}

TEST_P(MapRange, NoFarTest_DarkensEverythingBeyond) {
  EdgeScene edge;
  const RangeRule compared{Border::kBorder, false, true};
  EXPECT_GT(edge.dark(GetParam(), compared, is_beyond_far), 0.99);
  EXPECT_EQ(edge.dark(GetParam(), compared, is_outside_before_far), 0.0);
}

std::vector<float> full_of_casters(float depth) {
  return std::vector<float>(std::size_t{kRangeMapSize} * kRangeMapSize, depth);
}

/// What is read beyond an edge shows where casters stand everywhere.
TEST_P(MapRange, MapFullOfCasters_DarkensNothingOutside) {
  EdgeScene edge;
  edge.bench().map().upload(full_of_casters(0.02f));
  EXPECT_THAT(edge.draw(GetParam(), {}, is_outside), Each(FloatNear(1.0f, 1e-3f)));
}

/// Series repeat themselves where a receiver lies farther behind its caster than the map is deep.
TEST_P(MapRange, NoFarTest_DarkensWhatIsBehindACaster_HoweverDeep) {
  Bench bench(load_builtin("stack"), kRangeMapSize, 160, 90);
  const filters::FilterRequest request = request_of(GetParam());
  render::LightLayers light = bench.light(request);
  for (int column = 0; column < 4; ++column) light.front().frustum.uv_depth_from_world[column].z *= 1.6f;
  light.front().range.far_test = false;
  bench.map().upload(full_of_casters(0.02f));
  render::FilterPasses passes(bench.shaders(), request, bench.map(), light);
  const std::vector<float> image = bench.draw(passes);
  int deep = 0;
  for (const Receiver& r : render::read_receivers(bench.shaders(), bench.gbuffer(), light.front())) {
    const bool is_inside = glm::all(glm::lessThan(glm::abs(r.uv - 0.5f), glm::vec2(0.5f - kBeyondKernels)));
    if (!is_inside || r.depth < 1.005f) continue;
    ++deep;
    EXPECT_LT(image[bench.index(r)], 0.01f) << "at depth " << r.depth;
  }
  EXPECT_GT(deep, 1000);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, MapRange, ::testing::ValuesIn(filter_ids()),
                         [](const auto& each) { return each.param; });

TEST(MapRangeReceivers, LitByConvention_CountButAreNotAskedAbout) {
  EdgeScene edge;
  const auto request = request_of("none");
  edge.bench().set_range({});
  const std::size_t asked = edge.bench().receivers(request).size();
  const auto counted =
      render::count_receivers(edge.bench().shaders(), edge.bench().gbuffer(), edge.bench().light(request));
  EXPECT_LT(asked, edge.receivers());
  EXPECT_EQ(static_cast<std::size_t>(counted), edge.receivers());
}

TEST(MapRangeVariants, RightRule_CompilesNothingMore) {
  const render::LightSetup right{};
  EXPECT_TRUE(render::range_defines(right).empty());
  render::LightSetup wrong{};
  wrong.range = {Border::kRepeat, false, false};
  EXPECT_EQ(render::range_defines(wrong).size(), 1u) << "an orthographic map has no behind";
}

/// Projected through the lamp, a deck over it lies in the mirrored cone: without the test of what is behind, the map is
/// asked about it, at depths before its near plane.
TEST(BehindALamp, ADeckIsNotAskedAbout_UnlessTheTestIsOff) {
  scene::Scene scene = load_builtin("lamp");
  scene.meshes.push_back(scene::move_mesh(scene::make_plane({4.0f, 4.0f}, 1), {0.0, 6.0, 0.0}));
  // Sees the side that is turned to the lamp.
  scene.cameras = {scene::make_camera({-1.5f, 3.5f, 1.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, -1.0f})};
  Bench bench(scene, kRangeMapSize);
  const auto request = request_of("none");
  const auto find_deck = [&](const RangeRule& rule) {
    bench.set_range(rule);
    std::vector<Receiver> deck = bench.receivers(request);
    std::erase_if(deck, [](const Receiver& r) { return r.position_ws.y < 5.0f; });
    return deck;
  };
  EXPECT_EQ(find_deck({Border::kBorder, false, true}).size(), 0u);
  const std::vector<Receiver> deck = find_deck({Border::kBorder, false, false});
  EXPECT_GT(deck.size(), 1000u);
  EXPECT_TRUE(std::ranges::all_of(deck, [](const Receiver& r) { return r.depth < 0.0f; }));
}

constexpr int kShapeMap = 1024;

class CurvedMap : public ::testing::TestWithParam<std::string> {};

/// How a receiver's depth changes along its plane with one texel of u and of v, by steps on the plane.
glm::dvec2 step_on_plane(const scene::LightFrustum& frustum, const filters::Receiver& r) {
  const glm::dvec3 normal(r.normal_ws), position(r.position_ws);
  const glm::dvec3 side = glm::normalize(glm::cross(normal, glm::dvec3(0.6, 0.37, 0.71)));
  const double step = 1e-4 * static_cast<double>(r.texel_size_ws);
  glm::dmat2 texels;
  glm::dvec2 depths;
  for (int i = 0; i < 2; ++i) {
    const glm::dvec3 way = step * (i == 0 ? side : glm::cross(normal, side));
    const glm::dvec3 change = frustum.place(position + way, kShapeMap) - frustum.place(position - way, kShapeMap);
    texels[i] = glm::dvec2(change);
    depths[i] = change.z;
  }
  return depths * glm::inverse(texels);
}

TEST_P(CurvedMap, ReceiversLieWhereTheFrustumSays) {
  Bench bench(load_builtin(GetParam()), kShapeMap);
  double worst_texel = 0.0, worst_depth = 0.0, worst_size = 0.0, worst_plane = 0.0;
  int steep = 0;
  for (const filters::Receiver& r : bench.receivers(request_of("none"))) {
    if (r.layer_share == 0.0f) continue;
    const scene::LightFrustum& frustum = bench.layers()[static_cast<std::size_t>(r.layer)];
    const glm::dvec3 place = frustum.place(glm::dvec3(r.position_ws), kShapeMap);
    const double size = static_cast<double>(r.texel_size_ws), own = frustum.texel_size_at(glm::dvec3(r.position_ws));
    worst_texel = std::max(worst_texel, glm::distance(glm::dvec2(place), glm::dvec2(r.uv) * double{kShapeMap}));
    worst_depth = std::max(worst_depth, std::abs(place.z - static_cast<double>(r.depth_unbiased)));
    worst_size = std::max(worst_size, std::abs(size / own - 1.0));
    if (r.n_dot_l < 0.05f) continue;  // rounding of the normal outweighs the slope
    const glm::dvec2 slope = step_on_plane(frustum, r);
    worst_plane = std::max(worst_plane, glm::distance(slope, glm::dvec2(r.depth_per_texel)) / glm::length(slope));
    ++steep;
  }
  EXPECT_GT(steep, 10000);
  EXPECT_LT(worst_texel, 1e-3);
  EXPECT_LT(worst_depth, 1e-6);
  EXPECT_LT(worst_size, 1e-4);
  EXPECT_LT(worst_plane, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Shapes, CurvedMap,
                         ::testing::Values("lamp", "lantern", "avenue_by_focused", "avenue_by_lispsm", "avenue_by_psm",
                                           "avenue_by_tsm", "avenue_by_logpsm", "lantern_by_paraboloid"),
                         [](const auto& each) { return each.param; });

// The same scene at another size, from a file far from the origin, and turned so that its light goes along every axis.

constexpr int kPlacedWidth = 160, kPlacedHeight = 120;
constexpr float kOffVisibly = 0.1f;  // a pixel's visibility
constexpr double kShareOff = 0.01;   // so many pixels may be off by that

using Pictures = std::map<std::string, std::vector<float>>;

Pictures draw_placed(const scene::Scene& scene) {
  Bench bench(scene, 256, kPlacedWidth, kPlacedHeight);
  Pictures pictures;
  for (const char* id : {"none", "box3x3", "poisson", "vsm", "esm", "pcss"}) pictures[id] = bench.draw(request_of(id));
  return pictures;
}

/// The share of the pixels that are off. What is not finite is.
double find_share_off(const std::vector<float>& seen, const std::vector<float>& expected) {
  int off = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) off += std::abs(seen[i] - expected[i]) <= kOffVisibly ? 0 : 1;
  return static_cast<double>(off) / static_cast<double>(seen.size());
}

void expect_same(const Pictures& seen, const Pictures& expected) {
  for (const auto& [id, picture] : expected) {
    EXPECT_GT(std::ranges::count_if(picture, [](float v) { return v < 0.9f; }), 500) << id << " shows no shadow";
    EXPECT_LE(find_share_off(seen.at(id), picture), kShareOff) << id;
  }
}

template <class Place>
scene::Scene place(scene::Scene scene, const Place& place_point) {
  for (scene::Mesh& mesh : scene.meshes)
    for (scene::Vertex& v : mesh.vertices) v.position_ws = glm::vec3(place_point(glm::dvec3(v.position_ws)));
  for (scene::Camera& c : scene.cameras) c.position_ws = glm::vec3(place_point(glm::dvec3(c.position_ws)));
  return scene::validate(std::move(scene), "placed");
}

/// A floor under a slab whose edges no texel grid follows, and a wall that casts no shadow; the light goes straight
/// down unless it leans. All of it is turned.
scene::Scene make_turned_slab(const glm::dmat3& turn, const glm::dvec3& light = {0.0, -1.0, 0.0}) {
  const glm::dmat4 world(turn), none(1.0);
  const glm::dmat4 slab = glm::rotate(glm::translate(none, glm::dvec3(0.2, 1.0, -0.1)), glm::radians(20.0),
                                      glm::dvec3(0.0, 1.0, 0.0)),
                   wall = glm::rotate(glm::translate(none, glm::dvec3(-2.0, 0.6, 0.0)), glm::radians(-90.0),
                                      glm::dvec3(0.0, 0.0, 1.0));
  const glm::dvec3 eye(2.6, 3.6, 3.4), target(-0.2, 0.3, 0.0), up(0.0, 1.0, 0.0);
  scene::Scene scene = scene::make_scene_of({scene::transform_mesh(scene::make_plane({4.0f, 4.0f}, 8), world),
                                             scene::transform_mesh(scene::make_plane({1.5f, 1.0f}, 4), world * slab),
                                             scene::transform_mesh(scene::make_plane({1.2f, 4.0f}, 4), world * wall)},
                                            scene::Sun{glm::vec3(turn * glm::normalize(light))},
                                            {scene::make_camera(turn * eye, turn * (target - eye), turn * up)});
  scene.meshes.back().casts_shadow = false;
  return scene::validate(scene, "turned slab");
}

/// No length in the chain is absolute, and floats round alike at every size.
TEST(Placement, SceneOfAnySize_LooksTheSame) {
  const scene::Scene cubes = load_builtin("cubes");
  const Pictures expected = draw_placed(cubes);
  for (const double factor : {1e-6, 0.3, 7.0, 1e6}) {
    SCOPED_TRACE(factor);
    expect_same(draw_placed(place(cubes, [&](const glm::dvec3& p) { return factor * p; })), expected);
  }
}

/// A fence on a floor, whose file has it so far along x and z.
scene::Scene load_fence_at(double distance) {
  const auto at = [&](double x, double y, double z) {
    return fmt::format("[{:.12g}, {}, {:.12g}]\n", distance + x, y, distance + z);
  };
  const TestFolder folder;
  const std::string text =
      "title = \"fence\"\n[camera]\nvertical_fov_deg = 35\nposition = " + at(3.0, 2.5, 4.0) +
      "target = " + at(0.0, 0.5, 0.0) + "[light]\nazimuth_deg = 72\nelevation_deg = 38\n" +
      "[[object]]\nshape = \"plane\"\nsize = [8, 8]\ncenter = " + at(0.0, 0.0, 0.0) +
      "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nrotation_deg = [0, 30, 0]\ncenter = " + at(0.0, 0.5, 0.0) +
      "[[object]]\nshape = \"bars\"\ncount = 7\nbar_width = 0.08\n" +
      "spacing = 0.2\nlength = 1\ncenter = " + at(1.2, 0.5, 0.6);
  return scene::load(folder.write("fence.toml", text).string(), {});
}

/// The last pixels that differ are those where a silhouette or an edge of a shadow runs through a sample within some
/// roundings of a coordinate.
TEST(Placement, SceneOfAFileFarFromTheOrigin_LooksTheSame) {
  constexpr double kShareOfEdges = 6e-4;  // twice the most that was seen, 6 of 19 200 pixels
  const Pictures expected = draw_placed(load_fence_at(0.0));
  for (const double distance : {20.0, 100.0, 200.0, 500.0, 10e3, 1e6}) {
    SCOPED_TRACE(distance);
    const Pictures seen = draw_placed(load_fence_at(distance));
    for (const auto& [id, picture] : expected) EXPECT_LE(find_share_off(seen.at(id), picture), kShareOfEdges) << id;
  }
}

/// Compares what filters draw of a scene with what is traced at the same places, but for surfaces that light grazes:
/// there it must be a share of light, and no more is known.
void expect_traced_shadow(const scene::Scene& scene, const std::vector<std::string>& filters) {
  Bench bench(scene, 1024, kPlacedWidth, kPlacedHeight);
  const measure::ViewReceivers receivers = measure::read_view_receivers(bench.gbuffer(), scene.light);
  const images::Image traced = receivers.to_image(truth::trace_hard(
      truth::Occluders(scene::list_occluders(scene)), receivers.image, scene::make_area_light(scene.light)));
  const glm::vec3 to_light = scene::to_light(scene.light, {});
  for (const std::string& filter : filters) {
    const std::vector<float> drawn = bench.draw(request_of(filter));
    EXPECT_TRUE(std::ranges::all_of(drawn, [](float v) { return v >= 0.0f && v <= 1.0f; })) << filter;
    std::vector<float> seen, expected;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const int x = static_cast<int>(i) % kPlacedWidth, y = kPlacedHeight - 1 - static_cast<int>(i) / kPlacedWidth;
      const std::size_t at = static_cast<std::size_t>(y * kPlacedWidth + x);  // rows of images begin at the top
      if (std::abs(glm::dot(receivers.image.points[at].normal_ws, to_light)) < 0.02f) continue;
      seen.push_back(drawn[i]);
      expected.push_back(traced.texels[at]);
    }
    EXPECT_GT(std::ranges::count(expected, 0.0f), 500) << filter;
    EXPECT_LE(find_share_off(seen, expected), kShareOff) << filter;
  }
}

/// Exactly along an axis, and beside it, towards where the light's own axes may switch and between; one plane is at
/// right angles to the light, one parallel.
TEST(Placement, LightAlongEveryAxis_AndBesideIt_CastsTheShadowThatIsTraced) {
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const glm::dmat3 turns[] = {{x, y, z}, {-x, -y, z}, {-y, x, z}, {y, -x, z}, {x, z, -y}, {x, -z, y}};
  const std::pair<double, double> leans[] = {{0.0, 0.0},   {1e-9, 0.0},  {1e-9, 0.9}, {1e-4, 1.6},
                                             {0.17, 0.25}, {0.17, 1.57}, {0.17, 4.1}};
  for (const glm::dmat3& turn : turns) {
    for (const auto& [lean, to] : leans) {
      const glm::dvec3 light(lean * std::cos(to), -1.0, lean * std::sin(to));
      SCOPED_TRACE(fmt::format("along {}, {}, {}, {} off towards {}", -turn[1].x, -turn[1].y, -turn[1].z, lean, to));
      expect_traced_shadow(make_turned_slab(turn, light), {"none", "tent3x3", "vsm:radius=1"});
    }
  }
}

}  // namespace
}  // namespace shadowbench::test
