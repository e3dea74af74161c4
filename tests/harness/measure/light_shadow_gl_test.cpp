#include <cmath>

#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

// Shadows of every kind of light lie where geometry says, are as wide as it says, and move with light and caster: from
// a scene's light to its map, its rays and its truth. A sheet with a straight edge stands over a floor; everything is
// also turned on its side, so that the light comes from there.

constexpr int kShadowMap = 1024;

/// The sheet fills x < edge at this height; the light stands at `place`, or far away along it.
struct Stage {
  double edge = 0.3, height = 1.0;
  glm::dvec3 place{0.8, 3.0, 0.2};
  bool on_its_side = false;
};

enum class Kind { kSun, kDisk, kRectangle, kSphere };
constexpr std::array kKinds = {Kind::kSun, Kind::kDisk, Kind::kRectangle, Kind::kSphere};
constexpr float kHalfSize = 0.3f;  // of a lamp, metres
const char* name_of(Kind kind) {
  return std::array{"sun", "disk", "rectangle", "sphere"}[static_cast<std::size_t>(kind)];
}

glm::dmat4 turn_of(const Stage& stage) {
  return stage.on_its_side ? glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(1.0, 0.0, 0.0))
                           : glm::dmat4(1.0);
}

scene::LightKind make_kind(Kind kind, const Stage& stage) {
  const glm::dmat4 turn = turn_of(stage);
  const glm::vec3 place(turn * glm::dvec4(stage.place, 1.0));
  const glm::vec3 below(turn * glm::dvec4(stage.place.x, 0.0, stage.place.z, 1.0));
  switch (kind) {
    case Kind::kSun:
      return scene::Sun{glm::normalize(-place), glm::degrees(2.0f * std::atan(kHalfSize / glm::length(place)))};
    case Kind::kDisk: return scene::Spot{place, below, 120.0f, 118.0f, kHalfSize, {}};
    case Kind::kRectangle: return scene::Spot{place, below, 120.0f, 118.0f, 0.0f, {0.4f, 0.5f}};
    case Kind::kSphere: return scene::PointLight{place, kHalfSize, 3.0f};
  }
  return {};
}

scene::Scene make_stage(Kind kind, const Stage& stage) {
  const glm::dmat3 turn(turn_of(stage));
  const scene::Mesh floor = scene::make_plane({8.0f, 8.0f}, 8);
  const scene::Mesh sheet = scene::move_mesh(scene::make_plane({4.0f, 8.0f}, 8), {stage.edge - 2.0, stage.height, 0.0});
  scene::Camera camera =  // between the sheet and the floor
      scene::make_camera(turn * glm::dvec3(0.0, 0.8, 0.0), turn * glm::dvec3(0.0, -1.0, 0.0),
                         turn * glm::dvec3(0.0, 0.0, -1.0));
  camera.vertical_fov_rad = 1.4f;
  return scene::make_scene_of({scene::transform_mesh(floor, turn), scene::transform_mesh(sheet, turn)},
                              make_kind(kind, stage), {camera});
}

/// Where the shadow of the edge lies on the floor, for a light that is a point.
double edge_on_floor(Kind kind, const Stage& stage) {
  const double x = stage.place.x, y = stage.place.y;
  return kind == Kind::kSun ? stage.edge - stage.height * x / y : x + (stage.edge - x) * y / (y - stage.height);
}

/// A receiver's place on the floor.
glm::dvec3 on_floor(const Stage& stage, const glm::vec3& p) {
  return glm::dvec3(glm::transpose(turn_of(stage)) * glm::dvec4(p, 1.0));
}

class Shadow : public ::testing::TestWithParam<Kind> {};

void expect_edge(Kind kind, const Stage& stage) {
  const scene::Scene scene = make_stage(kind, stage);
  Bench bench(scene, kShadowMap, 320, 180);
  const std::vector<float> drawn = bench.draw(request_of("none"));
  const auto receivers = measure::read_view_receivers(bench.gbuffer(), scene.light);
  const truth::Occluders occluders(scene::list_occluders(scene));
  const std::vector<float> traced = truth::trace_hard(occluders, receivers.image, scene::make_area_light(scene.light));
  const std::vector<truth::ReceiverPoint>& points = receivers.image.points;
  const double edge = edge_on_floor(kind, stage);
  int lit = 0, blocked = 0, wrong_map = 0, wrong_rays = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].counts) continue;
    const double past = on_floor(stage, points[i].position_ws).x - edge;
    const float expected = past > 0.0 ? 1.0f : 0.0f;
    (past > 0.0 ? lit : blocked) += 1;
    double texel = 0.0;
    for (const scene::LightFrustum& layer : bench.layers())
      texel = std::max(texel, layer.texel_size_at(glm::dvec3(points[i].position_ws)));
    // The texel is seen along the light: on the floor it is longer.
    const double steepest = 1.5 * texel * glm::length(stage.place) / stage.place.y;
    const std::size_t row_up = 179 - i / 320;
    wrong_map += std::abs(past) > steepest && drawn[row_up * 320 + i % 320] != expected;
    wrong_rays += std::abs(past) > 1e-4 && traced[i] != expected;
  }
  EXPECT_GT(lit, 3000) << name_of(kind);
  EXPECT_GT(blocked, 3000) << name_of(kind);
  EXPECT_EQ(wrong_map, 0) << name_of(kind);
  EXPECT_EQ(wrong_rays, 0) << name_of(kind);
}

TEST_P(Shadow, LiesWhereGeometrySays_BeforeAndAfterLightAndCasterMove) {
  for (const bool on_its_side : {false, true}) {
    expect_edge(GetParam(), {.on_its_side = on_its_side});
    expect_edge(GetParam(), {.place = {0.4, 2.6, -0.3}, .on_its_side = on_its_side});
    expect_edge(GetParam(), {.edge = 0.15, .height = 1.2, .on_its_side = on_its_side});
  }
}

/// Points spread evenly over the light as a receiver sees it, and how many of them the sheet does not hide.
double share_seen(Kind kind, const Stage& stage, const glm::dvec3& p) {
  constexpr int kSide = 200;
  const glm::dvec3 to_light = kind == Kind::kSun ? stage.place : stage.place - p;
  const double distance = glm::length(to_light);
  const glm::dvec3 axis = to_light / distance;
  const glm::dvec3 side = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 0.1, 0.9))), up = glm::cross(axis, side);
  const double size = double{kHalfSize}, sine = size / distance;
  // A rectangle's sides are the map's u and v.
  const glm::dmat3 turn(turn_of(stage)),
      sides = glm::transpose(turn) * glm::transpose(scene::light_rotation(turn * glm::dvec3(0.0, -1.0, 0.0)));
  int seen = 0, all = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const glm::dvec2 at = 2.0 * glm::dvec2(i % kSide + 0.5, i / kSide + 0.5) / double{kSide} - 1.0;
    glm::dvec3 way;
    if (kind == Kind::kRectangle) {
      way = to_light + 0.5 * (0.4 * at.x * sides[0] + 0.5 * at.y * sides[1]);
    } else if (glm::length(at) > 1.0) {
      continue;
    } else if (kind == Kind::kDisk) {
      way = to_light + size * glm::dvec3(at.x, 0.0, at.y);
    } else if (kind == Kind::kSun) {
      way = axis + (size / distance) * (at.x * side + at.y * up);
    } else {  // equal areas of the disk are equal shares of the sphere's solid angle
      const double cap = (1.0 - std::sqrt(1.0 - sine * sine)) * glm::dot(at, at), across = std::sqrt(cap * (2.0 - cap));
      const double length = std::max(glm::length(at), 1e-12);
      way = (1.0 - cap) * axis + across / length * (at.x * side + at.y * up);
    }
    ++all;
    seen += p.x + way.x * stage.height / way.y > stage.edge;
  }
  return static_cast<double>(seen) / all;
}

TEST_P(Shadow, HasThePenumbraOfItsLight_FromEverySide) {
  for (const bool on_its_side : {false, true}) {
    const Stage stage{.on_its_side = on_its_side};
    const scene::Scene scene = make_stage(GetParam(), stage);
    Bench bench(scene, 256, 80, 45);
    const auto receivers = measure::read_view_receivers(bench.gbuffer(), scene.light);
    const truth::Occluders occluders(scene::list_occluders(scene));
    const truth::TracedVisibility traced =
        truth::trace_area(occluders, receivers.image, scene::make_area_light(scene.light), {.standard_error = 0.002});
    int partial = 0;
    double squares = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < traced.visibility.size(); ++i) {
      if (!receivers.image.points[i].counts) continue;
      const double exact = share_seen(GetParam(), stage, on_floor(stage, receivers.image.points[i].position_ws));
      if (exact <= 0.02 || exact >= 0.98) continue;
      const double difference = static_cast<double>(traced.visibility[i]) - exact;
      ++partial;
      squares += difference * difference;
      worst = std::max(worst, std::abs(difference));
    }
    EXPECT_GT(partial, 150);
    EXPECT_LT(std::sqrt(squares / partial), 0.004);
    EXPECT_LT(worst, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Shadow, ::testing::ValuesIn(kKinds),
                         [](const auto& each) { return std::string(name_of(each.param)); });

// Layers of a light's map, cascades and the faces of a cube: they share the receivers without a gap and without a seam.

constexpr int kLayersWidth = 320, kLayersHeight = 180, kLayersMap = 512;

std::vector<std::vector<float>> list_shares(Bench& bench) {
  std::vector<std::vector<float>> shares;
  for (const render::LightSetup& layer : bench.light(request_of("none")))
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
  Bench bench(scene, kLayersMap, kLayersWidth, kLayersHeight);
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
  std::vector<scene::Mesh> meshes = {scene::make_plane({4.0f, 4.0f}, 8)};
  if (caster)
    meshes.push_back(scene::transform_mesh(scene::make_box(caster->size, 4),
                                           glm::translate(glm::dmat4(1.0), caster->center) *
                                               glm::rotate(glm::dmat4(1.0), 0.35, glm::dvec3(0.0, 1.0, 0.0))));
  return scene::make_scene_of(meshes, scene::PointLight{{0.0f, 0.5f, 0.0f}, 0.02f, 0.5f},
                              {scene::look_down({0.0f, 2.0f, 0.0f}, 1.8f)});
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
  const std::vector<float> image = bench.draw(request_of(filter));
  std::vector<float> rows;
  for (int y = kLayersHeight - 1; y >= 0; --y)
    rows.insert(rows.end(), image.begin() + y * kLayersWidth, image.begin() + (y + 1) * kLayersWidth);
  return rows;
}

TEST(CubeFaces, ShowNoLineWhereTheyMeetOnALitFloor) {
  Bench bench(make_floor({}), kLayersMap, kLayersWidth, kLayersHeight);
  const auto borders = mark_borders(list_shares(bench), 1);
  ASSERT_GT(std::ranges::count(borders, std::uint8_t{1}), 300);
  for (const std::string& filter : filter_ids())
    EXPECT_GE(std::ranges::min(draw_rows(bench, filter)), 0.999f) << filter;
}

/// The same floor stood up before the lamp: two paraboloids meet in it along a level line.
TEST(Paraboloids, ShowNoLineWhereTheyMeetOnALitWall) {
  scene::Scene scene = make_floor({});
  scene.name = "wall_by_paraboloid";
  scene.meshes.front() = scene::transform_mesh(
      scene.meshes.front(), glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(1.0, 0.0, 0.0)));
  scene.light.kind = scene::PointLight{{0.0f, 0.0f, 0.5f}, 0.02f, 0.5f};
  scene.cameras = {scene::make_camera({0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, -1.0f})};
  scene.cameras.front().orthographic_height_m = 1.8f;
  Bench bench(scene, kLayersMap, kLayersWidth, kLayersHeight);
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
  const double widest = measure::largest_padding_texels(built_in().parse_requests("all,teaching"));
  Bench bench(scene, kLayersMap, kLayersWidth, kLayersHeight, {}, widest);
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
