#include "reference/truth/cut_out.h"

#include <cmath>

#include "reference/truth/embree.h"

namespace shadowbench::truth {
namespace {

int wrap(int i, int size) { return ((i % size) + size) % size; }

/// Bilinear, repeated, texel centres at .5; in [0,1].
float read_alpha(const CutOut& cut_out, glm::vec2 uv) {
  if (cut_out.width == 0) return 1.0f;
  const glm::vec2 at = uv * glm::vec2(cut_out.width, cut_out.height) - 0.5f;
  const glm::vec2 base = glm::floor(at), weight = at - base;
  const auto texel = [&](int dx, int dy) {
    const int x = wrap(static_cast<int>(base.x) + dx, cut_out.width),
              y = wrap(static_cast<int>(base.y) + dy, cut_out.height);
    return static_cast<float>(cut_out.alpha[static_cast<std::size_t>(y * cut_out.width + x)]) / 255.0f;
  };
  const float low = glm::mix(texel(0, 0), texel(1, 0), weight.x), high = glm::mix(texel(0, 1), texel(1, 1), weight.x);
  return glm::mix(low, high, weight.y);
}

}  // namespace

bool HoleTest::is_hole(std::uint32_t triangle, float u, float v) const {
  const std::uint32_t* corner = &indices[3 * static_cast<std::size_t>(triangle)];
  const glm::vec2 uv =
      (1.0f - u - v) * cut_out.uvs[corner[0]] + u * cut_out.uvs[corner[1]] + v * cut_out.uvs[corner[2]];
  return cut_out.base_alpha * read_alpha(cut_out, uv) < cut_out.cutoff;
}

void forgive_holes(const RTCFilterFunctionNArguments* arguments) {
  const auto& test = *static_cast<const HoleTest*>(arguments->geometryUserPtr);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    const float u = RTCHitN_u(arguments->hit, arguments->N, i), v = RTCHitN_v(arguments->hit, arguments->N, i);
    if (test.is_hole(triangle, u, v)) arguments->valid[i] = 0;
  }
}

}  // namespace shadowbench::truth
