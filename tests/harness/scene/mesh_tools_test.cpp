#include "harness/scene/mesh_tools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>

namespace shadowbench::scene {
namespace {

glm::dvec3 corner(const Mesh& mesh, std::size_t i) { return mesh.vertices[mesh.indices[i]].position_ws; }

glm::dvec3 face_normal(const Mesh& mesh, std::size_t first) {
  return area_normal(corner(mesh, first), corner(mesh, first + 1), corner(mesh, first + 2));
}

double area_of(const Mesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) area += 0.5 * glm::length(face_normal(mesh, i));
  return area;
}

/// By the divergence theorem: positive only where faces point outward.
double volume_of(const Mesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    volume += glm::dot(corner(mesh, i), face_normal(mesh, i)) / 6.0;
  return volume;
}

using Point = std::tuple<float, float, float>;

Point point_of(const Mesh& mesh, std::size_t i) {
  const glm::vec3 p = mesh.vertices[mesh.indices[i]].position_ws;
  return {p.x, p.y, p.z};
}

/// Every edge is walked once in each direction.
bool has_no_open_edge(const Mesh& mesh) {
  std::map<std::pair<Point, Point>, int> walks;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = point_of(mesh, i + k);
      const Point b = point_of(mesh, i + (k + 1) % 3);
      ++walks[{a, b}];
      --walks[{b, a}];
    }
  }
  return std::ranges::all_of(walks, [](const auto& walk) { return walk.second == 0; });
}

void expect_sound(const Mesh& mesh) {
  ASSERT_FALSE(mesh.indices.empty());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 normal = face_normal(mesh, i);
    ASSERT_GT(glm::length(normal), 0.0) << "triangle " << i / 3 << " has no area";
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 shading = mesh.vertices[mesh.indices[i + k]].normal_ws;
      ASSERT_NEAR(glm::length(shading), 1.0, 1e-6);
      ASSERT_GT(glm::dot(shading, glm::normalize(normal)), 0.5) << "triangle " << i / 3 << " is wound the wrong way";
    }
  }
}

TEST(PrimitivesTest, Plane_FacesUpAndHasItsAreaAndCells) {
  const Mesh plane = make_plane({3.0f, 2.0f}, 5);
  expect_sound(plane);
  EXPECT_EQ(plane.indices.size(), 5U * 5U * 6U);
  EXPECT_NEAR(area_of(plane), 6.0, 1e-6);
  for (std::size_t i = 0; i < plane.indices.size(); i += 3) EXPECT_GT(face_normal(plane, i).y, 0.0);
}

TEST(PrimitivesTest, Box_IsClosedFacesOutwardAndHasItsSize) {
  const Mesh box = make_box({1.0f, 2.0f, 0.25f}, 8);
  expect_sound(box);
  EXPECT_TRUE(has_no_open_edge(box));
  EXPECT_NEAR(volume_of(box), 0.5, 1e-6);
  EXPECT_NEAR(area_of(box), 2.0 * (2.0 + 0.5 + 0.25), 1e-6);
  EXPECT_EQ(box.indices.size(), 2U * 6U * (4U * 8U + 8U * 1U + 4U * 1U));
}

TEST(PrimitivesTest, Sphere_IsClosedFacesOutwardAndNearsItsVolume) {
  const Mesh sphere = make_sphere(2.0f, 96);
  expect_sound(sphere);
  EXPECT_TRUE(has_no_open_edge(sphere));
  EXPECT_NEAR(volume_of(sphere) / (32.0 / 3.0 * std::numbers::pi), 1.0, 5e-3);
  for (const Vertex& v : sphere.vertices) EXPECT_NEAR(glm::length(v.position_ws), 2.0f, 1e-5f);
}

TEST(PrimitivesTest, Cylinder_IsClosedFacesOutwardAndNearsItsVolume) {
  const Mesh cylinder = make_cylinder(0.5f, 3.0f, {.segments = 64, .cells = 6});
  expect_sound(cylinder);
  EXPECT_TRUE(has_no_open_edge(cylinder));
  EXPECT_NEAR(volume_of(cylinder) / (0.75 * std::numbers::pi), 1.0, 5e-3);
}

TEST(PrimitivesTest, Bars_AreAsManyAsCountedAndSpacedAsSaid) {
  const Mesh bars = make_bars({.count = 3, .bar_width_m = 0.1f, .spacing_m = 0.5f, .length_m = 2.0f});
  expect_sound(bars);
  EXPECT_TRUE(has_no_open_edge(bars));
  EXPECT_NEAR(volume_of(bars), 3 * 0.1 * 0.1 * 2.0, 1e-6);
  Bounds box;
  for (const Vertex& v : bars.vertices) box.add(v.position_ws);
  EXPECT_FLOAT_EQ(box.max.x, 0.55f);
  EXPECT_FLOAT_EQ(box.max.y, 1.0f);
  EXPECT_FLOAT_EQ(box.max.z, 0.05f);
}

TEST(PrimitivesTest, BarsOfBothDirections_ShareNoFrontPlane) {
  const Mesh bars = make_bars({.count = 2, .bar_width_m = 0.1f, .direction = BarDirection::kBoth});
  EXPECT_NEAR(volume_of(bars), 2 * 2.0 * (0.01 + 0.0064), 1e-6);
}

TEST(MeshToolsTest, MirroringTransform_KeepsFacesOutward) {
  const glm::dmat4 mirror(glm::dmat3(-2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0));
  const Mesh box = transform_mesh(make_box(glm::vec3(1.0f), 2), mirror);
  expect_sound(box);
  EXPECT_NEAR(volume_of(box), 2.0, 1e-6);
}

TEST(MeshToolsTest, UnevenScale_KeepsNormalsAcrossTheSurface) {
  const glm::dmat4 stretch(glm::dmat3(1.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 1.0));
  const Mesh sphere = transform_mesh(make_sphere(1.0f, 192), stretch);
  for (std::size_t i = 0; i < sphere.indices.size(); i += 3) {
    const glm::dvec3 face = glm::normalize(face_normal(sphere, i));
    const glm::dvec3 shading = sphere.vertices[sphere.indices[i]].normal_ws;
    ASSERT_GT(glm::dot(face, shading), 0.9);
  }
}

TEST(MeshToolsTest, FlatNormals_AreThoseOfTheFaces) {
  const Mesh flat = with_flat_normals(make_sphere(1.0f, 8));
  for (std::size_t i = 0; i < flat.indices.size(); ++i) {
    const glm::dvec3 face = glm::normalize(face_normal(flat, i - i % 3));
    ASSERT_NEAR(glm::dot(face, glm::dvec3(flat.vertices[flat.indices[i]].normal_ws)), 1.0, 1e-6);
  }
}

TEST(MeshToolsTest, SmoothNormals_RoundASphereAndKeepABoxSharp) {
  for (const Vertex& v : with_smooth_normals(make_sphere(1.0f, 64), 45.0).vertices)
    ASSERT_GT(glm::dot(v.normal_ws, glm::normalize(v.position_ws)), 0.999f);
  const Mesh box = make_box(glm::vec3(1.0f), 2);
  const Mesh smooth = with_smooth_normals(box, 45.0);
  for (std::size_t i = 0; i < box.indices.size(); ++i) {
    const glm::vec3 before = box.vertices[box.indices[i]].normal_ws;
    ASSERT_GT(glm::dot(smooth.vertices[smooth.indices[i]].normal_ws, before), 0.9999f);
  }
}

TEST(MeshToolsTest, UnusedVertices_AreDroppedAndFacesStay) {
  Mesh mesh = make_plane({1.0f, 1.0f}, 1);
  mesh.vertices.insert(mesh.vertices.begin(), {glm::vec3(99.0f), {}, {}});
  for (std::uint32_t& index : mesh.indices) ++index;
  const Mesh compact = without_unused_vertices(mesh);
  EXPECT_EQ(compact.vertices.size(), 4U);
  EXPECT_NEAR(area_of(compact), 1.0, 1e-6);
}

TEST(NormalTree, Sums_WhatALookAtEachFaceSums) {
  std::mt19937 random(1);
  std::normal_distribution<double> spread;
  std::vector<FaceNormal> all;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 area{spread(random), spread(random), i % 3 == 0 ? 0.0 : spread(random)};
    all.push_back(i % 100 == 0 ? FaceNormal{} : FaceNormal{area, glm::dvec3(glm::vec3(glm::normalize(area)))});
  }
  std::vector<std::size_t> some(2500);
  std::iota(some.begin(), some.end(), 250);
  const NormalTree tree(all, some);
  for (const double degrees : {1.0, 30.0, 45.0, 80.0, 120.0}) {
    const double cosine = std::cos(glm::radians(degrees));
    for (const std::size_t query : some) {
      glm::dvec3 sum(0.0);
      for (const std::size_t face : some)
        if (glm::dot(all[face].normal, all[query].normal) >= cosine) sum += all[face].area_normal;
      EXPECT_LT(glm::length(tree.sum(all[query].normal, cosine) - sum), 1e-9) << degrees << " " << query;
    }
  }
}

}  // namespace
}  // namespace shadowbench::scene
