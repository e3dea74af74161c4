// Layers of a light's map, cascades and the faces of a cube: they share the receivers without a gap and without a seam.

#include <glm/gtc/matrix_transform.hpp>

#include "filters/model.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kLayersWidth = 320, kLayersHeight = 180, kLayersMap = 512;

std::vector<std::vector<float>> list_shares(Bench& bench) {
  std::vector<std::vector<float>> shares;
  for (const render::LightSetup& layer : bench.light(catalogue().parse_requests("none").front()))
    shares.push_back(render::read_layer_shares(bench.shaders(), bench.gbuffer(), layer));
  return shares;
}

/// How many layers serve a pixel, and by which share in all.
struct Served {
  int layers = 0;
  float share = 0.0f;
};

Served count_served(const std::vector<std::vector<float>>& shares, std::size_t pixel) {
  Served served;
  for (const std::vector<float>& layer : shares) {
    served.layers += layer[pixel] > 0.0f ? 1 : 0;
    served.share += layer[pixel];
  }
  return served;
}

class Layers : public ::testing::TestWithParam<std::string> {};

TEST_P(Layers, ShareEveryReceiver) {
  const scene::Scene scene = load_builtin(GetParam());
  Bench bench(shared_context(), scene, kLayersMap, kLayersWidth, kLayersHeight);
  const auto shares = list_shares(bench);
  ASSERT_GE(shares.size(), 2u);
  const auto receivers = measure::read_view_receivers(bench.gbuffer(), scene.light);
  int counted = 0, blended = 0;
  std::vector<int> of_layer(shares.size());
  for (std::size_t i = 0; i < receivers.image.points.size(); ++i) {
    if (!receivers.image.points[i].counts) continue;
    const Served served = count_served(shares, i);
    ++counted;
    blended += served.layers > 1 ? 1 : 0;
    EXPECT_NEAR(served.share, 1.0f, 1e-6f);
    for (std::size_t layer = 0; layer < shares.size(); ++layer) of_layer[layer] += shares[layer][i] > 0.0f ? 1 : 0;
  }
  std::printf("%s: %d receivers, %d blended\n", GetParam().c_str(), counted, blended);
  EXPECT_GT(counted, 10000);
  EXPECT_EQ(blended > 0, GetParam() == "avenue") << "cascades blend, the faces of a cube do not";
  for (const int count : of_layer) EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Layers, ::testing::Values("lantern", "avenue", "lantern_by_paraboloid"),
                         [](const auto& each) { return each.param; });

/// A box that casts a shadow on the floor.
struct Caster {
  glm::vec3 size;
  glm::dvec3 center;
};

/// A floor under a lamp at half a metre: the faces of its map meet there half a metre from the middle.
scene::Scene make_floor(const std::optional<Caster>& caster) {
  scene::Scene scene;
  scene.name = "floor";
  scene.meshes.push_back(scene::make_plane({4.0f, 4.0f}, 8));
  if (caster)
    scene.meshes.push_back(scene::transform_mesh(scene::make_box(caster->size, 4),
                                                 glm::translate(glm::dmat4(1.0), caster->center) *
                                                     glm::rotate(glm::dmat4(1.0), 0.35, glm::dvec3(0.0, 1.0, 0.0))));
  for (scene::Mesh& mesh : scene.meshes) mesh.material = 0;
  scene.materials.emplace_back();
  scene.light.kind = scene::PointLight{{0.0f, 0.5f, 0.0f}, 0.02f, 0.5f};
  scene::Camera camera;
  camera.name = "main";
  camera.position_ws = {0.0f, 2.0f, 0.0f};
  camera.forward_ws = {0.0f, -1.0f, 0.0f};
  camera.up_ws = {0.0f, 0.0f, -1.0f};
  camera.orthographic_height_m = 1.8f;
  scene.cameras.push_back(camera);
  return scene;
}

/// Marks receivers whose neighbour on some side is served by another layer.
std::vector<std::uint8_t> mark_borders(const std::vector<std::vector<float>>& shares, int reach) {
  std::vector<int> layer(shares.front().size(), -1);
  for (std::size_t i = 0; i < layer.size(); ++i)
    for (std::size_t k = 0; k < shares.size(); ++k)
      if (shares[k][i] > 0.0f) layer[i] = static_cast<int>(k);
  std::vector<std::uint8_t> marked(layer.size());
  for (int y = reach; y + reach < kLayersHeight; ++y) {
    for (int x = reach; x + reach < kLayersWidth; ++x) {
      const auto at = [&](int px, int py) { return layer[static_cast<std::size_t>(py * kLayersWidth + px)]; };
      const bool meets = at(x - reach, y) != at(x, y) || at(x + reach, y) != at(x, y) || at(x, y - reach) != at(x, y) ||
                         at(x, y + reach) != at(x, y);
      marked[static_cast<std::size_t>(y * kLayersWidth + x)] = meets ? 1 : 0;
    }
  }
  return marked;
}

/// Visibility, rows top to bottom as shares have them.
std::vector<float> draw_rows(Bench& bench, const std::string& filter) {
  const std::vector<float> image = bench.draw(catalogue().parse_requests(filter).front());
  std::vector<float> rows;
  for (int y = kLayersHeight - 1; y >= 0; --y)
    rows.insert(rows.end(), image.begin() + y * kLayersWidth, image.begin() + (y + 1) * kLayersWidth);
  return rows;
}

TEST(CubeFaces, ShowNoLineWhereTheyMeetOnALitFloor) {
  const scene::Scene scene = make_floor({});
  Bench bench(shared_context(), scene, kLayersMap, kLayersWidth, kLayersHeight);
  const auto borders = mark_borders(list_shares(bench), 1);
  ASSERT_GT(std::ranges::count(borders, std::uint8_t{1}), 300);
  for (const std::string& filter : filter_ids()) {
    const std::vector<float> image = draw_rows(bench, filter);
    float darkest = 1.0f;
    for (const float v : image) darkest = std::min(darkest, v);
    EXPECT_GE(darkest, 0.999f) << filter;
  }
}

/// The same floor stood up before the lamp: two paraboloids meet in it along a level line.
TEST(Paraboloids, ShowNoLineWhereTheyMeetOnALitWall) {
  scene::Scene scene = make_floor({});
  scene.name = "wall_by_paraboloid";
  scene.meshes.front() = scene::transform_mesh(
      scene.meshes.front(), glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(1.0, 0.0, 0.0)));
  scene.light.kind = scene::PointLight{{0.0f, 0.0f, 0.5f}, 0.02f, 0.5f};
  scene.cameras.front().position_ws = {0.0f, 0.0f, 2.0f};
  scene.cameras.front().forward_ws = {0.0f, 0.0f, -1.0f};
  scene.cameras.front().up_ws = {0.0f, 1.0f, 0.0f};
  Bench bench(shared_context(), scene, kLayersMap, kLayersWidth, kLayersHeight);
  const auto borders = mark_borders(list_shares(bench), 1);
  ASSERT_GT(std::ranges::count(borders, std::uint8_t{1}), 300);
  for (const std::string& filter : filter_ids()) {
    const std::vector<float> image = draw_rows(bench, filter);
    float darkest = 1.0f;
    for (std::size_t i = 0; i < image.size(); ++i)
      if (borders[i] == 1) darkest = std::min(darkest, image[i]);
    EXPECT_GE(darkest, 0.999f) << filter;
  }
}

/// The mean of an image over a rectangle of the floor, metres.
double mean_over(const std::vector<float>& image, double from_x, double to_x, double half_z) {
  constexpr double kPixel = 1.8 / kLayersHeight;
  double sum = 0.0, n = 0.0;
  for (int y = 0; y < kLayersHeight; ++y) {
    for (int x = 0; x < kLayersWidth; ++x) {
      const double at_x = (x + 0.5 - 0.5 * kLayersWidth) * kPixel, at_z = (y + 0.5 - 0.5 * kLayersHeight) * kPixel;
      if (at_x < from_x || at_x > to_x || std::abs(at_z) > half_z) continue;
      sum += static_cast<double>(image[static_cast<std::size_t>(y * kLayersWidth + x)]);
      n += 1.0;
    }
  }
  return sum / n;
}

/// A kernel that reads beyond its face's map would find light there.
TEST(CubeFaces, ShowNoLineWhereTheyMeetInAShadow) {
  const scene::Scene scene = make_floor(Caster{{0.16f, 0.01f, 0.16f}, {0.2, 0.3, 0.0}});
  const double widest = measure::largest_padding_texels(catalogue().parse_requests("all,teaching"));
  Bench bench(shared_context(), scene, kLayersMap, kLayersWidth, kLayersHeight, {}, widest);
  for (const std::string& filter : filter_ids()) {
    const std::vector<float> image = draw_rows(bench, filter);
    const double border = mean_over(image, 0.49, 0.51, 0.05), beside = mean_over(image, 0.43, 0.47, 0.05);
    EXPECT_NEAR(border, beside, 0.003) << filter;
    EXPECT_LT(beside, 0.2) << filter;
  }
}

/// A trace by layers is one through each layer's own grid.
TEST(LayerTruth, OfLayersThatAgree_IsWholeAndUnanimous) {
  const truth::ReceiverImage receivers{3, 1, std::vector<truth::ReceiverPoint>(3, {{}, {0.0f, 1.0f, 0.0f}, true}), {}};
  const std::vector<measure::TracedLayer> layers = {{{}, {1.0f, 0.25f, 0.5f}, "a"}, {{}, {0.0f, 0.75f, 0.5f}, "b"}};
  const auto traced = measure::trace_layers(
      layers, receivers, [](const truth::ReceiverImage& own, const truth::MapGrid&, std::size_t layer) {
        truth::TracedVisibility each{
            {0.0f, 1.0f, layer == 0 ? 0.0f : 1.0f}, {0.0f, 0.0f, 0.1f}, {1, 1, 1}, {64, 64, 64}};
        each.variance = {0.0f, 0.0f, layer == 0 ? 0.01f : 0.09f};
        if (layer == 1) EXPECT_FALSE(own.points[0].counts);
        return each;
      });
  EXPECT_EQ(traced.visibility, (std::vector<float>{0.0f, 1.0f, 0.5f}));
  EXPECT_EQ(traced.unanimous, (std::vector<std::uint8_t>{1, 1, 0})) << "the layers disagree on the last";
  EXPECT_EQ(traced.rays[1], truth::kRaysOfSettledPixel);
  EXPECT_NE(traced.rays[2], truth::kRaysOfSettledPixel);
  EXPECT_NEAR(traced.variance[2], 0.04f, 1e-6f) << "deviations of 0.1 and 0.3, of the same samples";
}

}  // namespace
}  // namespace shadowbench::test
