#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

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
