#include "harness/scene/normal_tree.h"

#include <algorithm>

namespace shadowbench::scene {
namespace {

constexpr std::size_t kLeafFaces = 16;
constexpr double kCosineRounding = 1e-12;  // of a cosine: nearer to the limit, each face is looked at

}  // namespace

NormalTree::NormalTree(const std::vector<FaceNormal>& all, const std::vector<std::size_t>& faces) {
  for (const std::size_t face : faces) faces_.push_back(all[face]);
  build(0, faces_.size());
}

void NormalTree::build(std::size_t begin, std::size_t end) {
  const std::size_t at = nodes_.size();
  Node node{begin, end, faces_[begin].normal, faces_[begin].normal};
  for (std::size_t i = begin; i < end; ++i) {
    node.low = glm::min(node.low, faces_[i].normal);
    node.high = glm::max(node.high, faces_[i].normal);
    node.sum += faces_[i].area_normal;
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafFaces) return;
  const glm::dvec3 size = node.high - node.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto place = [&](std::size_t i) { return faces_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(place(begin), place(middle), place(end),
                   [&](const FaceNormal& a, const FaceNormal& b) { return a.normal[axis] < b.normal[axis]; });
  build(begin, middle);
  nodes_[at].second = nodes_.size();
  build(middle, end);
}

glm::dvec3 NormalTree::sum(const glm::dvec3& direction, double least_cosine) const {
  glm::dvec3 total(0.0);
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t at = open.back();
    const Node& node = nodes_[at];
    open.pop_back();
    const glm::dvec3 a = direction * node.low, b = direction * node.high;
    const glm::dvec3 least = glm::min(a, b), most = glm::max(a, b);
    if (most.x + most.y + most.z < least_cosine - kCosineRounding) continue;
    if (least.x + least.y + least.z > least_cosine + kCosineRounding) {
      total += node.sum;
    } else if (node.second > 0) {
      open.insert(open.end(), {node.second, at + 1});
    } else {
      for (std::size_t i = node.begin; i < node.end; ++i)
        if (glm::dot(faces_[i].normal, direction) >= least_cosine) total += faces_[i].area_normal;
    }
  }
  return total;
}

}  // namespace shadowbench::scene
