// Shadows of every kind of light lie where geometry says, are as wide as it says, and move with light and caster: from
// a scene's light to its map, its rays and its truth. A sheet with a straight edge stands over a floor; everything is
// also turned on its side, so that the light comes from there.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "harness/measure/view_receivers.h"
#include "harness/render/bias.h"
#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

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
  const glm::dmat4 turn = turn_of(stage);
  scene::Scene scene;
  scene.name = "stage";
  scene.materials.emplace_back();
  const glm::dvec3 to_sheet(stage.edge - 2.0, stage.height, 0.0);
  scene.meshes.push_back(scene::transform_mesh(scene::make_plane({8.0f, 8.0f}, 8), turn));
  scene.meshes.push_back(
      scene::transform_mesh(scene::make_plane({4.0f, 8.0f}, 8), turn * glm::translate(glm::dmat4(1.0), to_sheet)));
  for (scene::Mesh& mesh : scene.meshes) mesh.material = 0;
  scene.light.kind = make_kind(kind, stage);
  scene::Camera camera;  // between the sheet and the floor
  camera.position_ws = glm::vec3(turn * glm::dvec4(0.0, 0.8, 0.0, 1.0));
  camera.forward_ws = glm::vec3(turn * glm::dvec4(0.0, -1.0, 0.0, 0.0));
  camera.up_ws = glm::vec3(turn * glm::dvec4(0.0, 0.0, -1.0, 0.0));
  camera.vertical_fov_rad = 1.4f;
  scene.cameras.push_back(camera);
  return scene;
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

/// Rows bottom to top.
std::vector<truth::ReceiverPoint> flip_rows(const truth::ReceiverImage& image) {
  std::vector<truth::ReceiverPoint> points;
  for (int y = image.height - 1; y >= 0; --y)
    points.insert(points.end(), image.points.begin() + y * image.width, image.points.begin() + (y + 1) * image.width);
  return points;
}

void expect_edge(Kind kind, const Stage& stage) {
  const scene::Scene scene = make_stage(kind, stage);
  Bench bench(shared_context(), scene, kShadowMap, 320, 180);
  const std::vector<float> drawn = bench.draw(catalogue().parse_requests("none").front());
  const auto receivers = measure::read_view_receivers(bench.gbuffer(), scene.light);
  const truth::Occluders occluders(scene::list_occluders(scene));
  const std::vector<float> traced = truth::trace_hard(occluders, receivers.image, scene::make_area_light(scene.light));
  const auto points = flip_rows(receivers.image);
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
    wrong_map += std::abs(past) > steepest && drawn[i] != expected;
    const std::size_t row = i / 320, rows_down = (179 - row) * 320 + i % 320;
    wrong_rays += std::abs(past) > 1e-4 && traced[rows_down] != expected;
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
    Bench bench(shared_context(), scene, 256, 80, 45);
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
    std::printf("%s%s: %d receivers in the penumbra, rms %.4f, worst %.4f\n", name_of(GetParam()),
                on_its_side ? " on its side" : "", partial, std::sqrt(squares / partial), worst);
    EXPECT_GT(partial, 150);
    EXPECT_LT(std::sqrt(squares / partial), 0.004);
    EXPECT_LT(worst, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Shadow, ::testing::ValuesIn(kKinds),
                         [](const auto& each) { return std::string(name_of(each.param)); });

}  // namespace
}  // namespace shadowbench::test
