#include "harness/scene/closed_mesh.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace shadowbench::scene {
namespace {

using Place = std::tuple<float, float, float>;

/// Numbers the places of a mesh's vertices, the same for vertices at the same place.
std::vector<int> number_places(const Mesh& mesh) {
  std::map<Place, int> numbers;
  std::vector<int> places;
  for (const Vertex& vertex : mesh.vertices) {
    const glm::vec3 p = vertex.position_ws + 0.0f;  // -0 becomes 0
    places.push_back(numbers.emplace(Place(p.x, p.y, p.z), static_cast<int>(numbers.size())).first->second);
  }
  return places;
}

}  // namespace

bool is_closed(const Mesh& mesh) {
  const std::vector<int> places = number_places(mesh);
  std::map<std::pair<int, int>, int> balance;  // edges of lower to higher number count up, the others down
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const int corner[] = {places[mesh.indices[i]], places[mesh.indices[i + 1]], places[mesh.indices[i + 2]]};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (int k = 0; k < 3; ++k) {
      const int a = corner[k], b = corner[(k + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return !balance.empty() &&
         std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

}  // namespace shadowbench::scene
