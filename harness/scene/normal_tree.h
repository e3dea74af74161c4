#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace shadowbench::scene {

/// A triangle's normal times twice its area, and its unit normal, zero where it has no area.
struct FaceNormal {
  glm::dvec3 area_normal;
  glm::dvec3 normal;
};

/// Sums the normals of many faces within an angle of a direction, without a look at each: a k-d tree of unit normals.
/// Cost: n log n to make; a sum takes some sqrt(n) steps at most where the normals are spread over the sphere.
class NormalTree {
 public:
  /// Requires one face or more.
  NormalTree(const std::vector<FaceNormal>& all, const std::vector<std::size_t>& faces);

  /// The sum of `area_normal` over the faces whose normal has at least this cosine with a unit direction.
  glm::dvec3 sum(const glm::dvec3& direction, double least_cosine) const;

 private:
  struct Node {
    std::size_t begin = 0, end = 0;  ///< faces
    glm::dvec3 low{0.0}, high{0.0};  ///< bounds of their normals
    glm::dvec3 sum{0.0};
    std::size_t second = 0;  ///< the second child, the first one follows its parent; 0: a leaf
  };

  std::vector<FaceNormal> faces_;
  std::vector<Node> nodes_;

  void build(std::size_t begin, std::size_t end);
};

}  // namespace shadowbench::scene
