#include "harness/scene/files/big_faces.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "harness/scene/files/obj_file.h"
#include "tests/harness/scene/test_files.h"

namespace shadowbench::scene {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

using Polygon = std::vector<glm::dvec3>;

constexpr int kMany = 300000;  // what takes the square of that takes minutes

Polygon make_star(int corners, double inner) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners, radius = i % 2 == 0 ? 1.0 : inner;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return polygon;
}

/// Long thin teeth, each leaning by `lean`.
Polygon make_comb(int corners, double lean) {
  Polygon polygon;
  for (int i = 0; i < corners - 3; ++i)
    polygon.emplace_back(1.0 - 1.0 * i / corners + (i % 2 == 1 ? lean : 0.0), i % 2 == 1 ? 1.0 : 0.0, 0.0);
  polygon.emplace_back(0.0, -1.0, 0.0);
  polygon.emplace_back(1.0, -1.0, 0.0);
  return polygon;
}

/// A corridor that winds inwards.
Polygon make_spiral(int corners) {
  Polygon polygon;
  const int half = corners / 2;
  for (int i = 0; i < 2 * half; ++i) {
    const int step = i < half ? i : 2 * half - 1 - i;
    const double angle = 20.0 * std::numbers::pi * step / half, radius = 1.0 + angle + (i < half ? 1.0 : 0.0);
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return polygon;
}

/// A square with very many corners along its straight sides.
Polygon make_square(int corners) {
  Polygon polygon;
  const int side = corners / 4;
  const glm::dvec3 at[] = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  for (int i = 0; i < 4 * side; ++i)
    polygon.push_back(at[i / side] + (at[(i / side + 1) % 4] - at[i / side]) * (1.0 * (i % side) / side));
  return polygon;
}

glm::dvec3 area_of(const Polygon& polygon) {
  glm::dvec3 area(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += 0.5 * glm::cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return area;
}

/// Triangles cover a polygon once where all face its way and their areas add up to its own.
void expect_covered(const Polygon& polygon, const std::string& name) {
  const std::vector<std::uint32_t> triangles = triangulate(polygon);
  ASSERT_EQ(triangles.size(), 3 * (polygon.size() - 2)) << name;
  const glm::dvec3 whole = area_of(polygon);
  double sum = 0.0;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const double area = glm::dot(area_of({polygon[triangles[i]], polygon[triangles[i + 1]], polygon[triangles[i + 2]]}),
                                 glm::normalize(whole));
    EXPECT_GE(area, -1e-12 * glm::length(whole)) << name << " " << i;
    sum += area;
  }
  EXPECT_NEAR(sum, glm::length(whole), 1e-9 * glm::length(whole)) << name;
}

std::string write_face(const Polygon& polygon) {
  std::string text, face = "f";
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    text += fmt::format("v {} {} {}\n", polygon[i].x, polygon[i].y, polygon[i].z);
    face += fmt::format(" {}", i + 1);
  }
  return text + face + "\n";
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Triangulate, ShapesOfEveryKind_AreCoveredOnce) {
  for (const int corners : {4, 8, 100, 1000, kMany / 3}) {
    expect_covered(make_star(corners, 1.0), "a circle");
    expect_covered(make_star(corners, 0.5), "a star");
    expect_covered(make_comb(corners, 0.0), "a comb");
    expect_covered(make_comb(corners, 0.7), "a leaning comb");
    expect_covered(make_square(corners), "a square");
    if (corners >= 1000) expect_covered(make_spiral(corners), "a spiral");
  }
}

TEST(Triangulate, PolygonFromEverySide_KeepsItsSense) {
  Polygon turned = make_star(500, 0.5);
  for (glm::dvec3& corner : turned) corner = {0.3 * corner.x, corner.y - corner.x, 0.2 * corner.y};
  expect_covered(turned, "turned");
  std::ranges::reverse(turned);
  expect_covered(turned, "reversed");
}

TEST(Triangulate, Tangle_StillGivesTriangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  Polygon tangle;
  for (int i = 0; i < 10000; ++i) tangle.emplace_back(place(random), place(random), 0.0);
  EXPECT_EQ(triangulate(tangle).size(), 3U * 9998U);
  EXPECT_EQ(triangulate(Polygon(1000, {1.0, 2.0, 3.0})).size(), 3U * 998U) << "all corners at one point";
}

TEST(BigFaces, OfHundredsOfCornersAlone_AreSplit) {
  const std::string ordinary = write_face(make_star(256, 0.5));
  EXPECT_EQ(split_big_faces(ordinary, "x.obj"), ordinary);
  const std::string big = write_face(make_star(257, 1.0)) + "g rest\n";
  const std::string split = split_big_faces(big, "x.obj");
  EXPECT_EQ(std::ranges::count(split, '\n'), 257 + 255 + 1);
  EXPECT_THAT(split, EndsWith("g rest\n"));
}

TEST(BigFaces, IndexThatNamesNoVertex_NamesItsLine) {
  const std::string text = write_face(make_star(300, 1.0));
  for (const char* wrong : {"301", "-301"}) {
    std::string bad = text;
    bad.replace(bad.rfind("300"), 3, wrong);
    const Error error = error_of([&] { split_big_faces(bad, "x.obj"); });
    EXPECT_THAT(error.message(), HasSubstr(fmt::format("vertex {}, but there are 300", wrong)));
    EXPECT_EQ(error.where(), "x.obj:301");
  }
}

TEST(ObjFileTest, FaceOfVeryManyCorners_IsReadInSeconds) {
  const TestFolder folder;
  const auto file = folder.write("test.obj", write_face(make_star(kMany, 0.9)));
  std::size_t indices = 0;
  EXPECT_LT(seconds_of([&] { indices = import_obj(file).meshes.at(0).indices.size(); }), 20.0);
  EXPECT_EQ(indices, 3U * (kMany - 2U));
}

TEST(ObjFileTest, FanOfVeryManyTriangles_IsReadInSeconds) {
  std::string text = "v 0 0 1\n";
  for (const glm::dvec3& corner : make_star(kMany, 1.0)) text += fmt::format("v {} {} 0\n", corner.x, corner.y);
  for (int i = 0; i < kMany; ++i) text += fmt::format("f 1 {} {}\n", i + 2, (i + 1) % kMany + 2);
  const TestFolder folder;
  const auto file = folder.write("test.obj", text);
  MeshFile model;
  EXPECT_LT(seconds_of([&] { model = import_obj(file); }), 20.0);
  const Vertex& tip = model.meshes.at(0).vertices.at(0);
  EXPECT_EQ(tip.position_ws, glm::vec3(0, 0, 1));
  EXPECT_GT(tip.normal_ws.x, 0.4f) << "of a cone of 90 degrees, the faces on the other side are beyond the crease";
  EXPECT_NEAR(tip.normal_ws.y, 0.0f, 1e-3f);
}

}  // namespace
}  // namespace shadowbench::scene
