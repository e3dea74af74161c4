// What every linear kernel does to a straight edge and to a corner, one texel further and in the mirror: filters of the
// kind `comparison` exactly, those of the kind `stochastic` in the mean over seeds.

#include <functional>
#include <numeric>

#include "tests/harness/render/analytic_floor.h"
#include "tests/harness/render/estimate.h"

namespace shadowbench::test {
namespace {

using filters::FilterKind;
using filters::FilterRequest;

constexpr std::uint32_t kEdgeSeeds = 64;
constexpr float kFar = 1e4f;  // casters are cut at the map's border

enum class Along { kU, kV };

std::uint32_t seeds_of(const FilterRequest& request) { return is_stochastic(request) ? kEdgeSeeds : 1; }

double radius_of(const FilterRequest& request) { return filters::radius_texels(request.spec, request.values); }

/// Turns means into estimates: what chance may do to a stochastic filter, and the steps of the hardware's weights.
std::vector<Estimate> estimate(const FilterRequest& request, const std::vector<MeanInUnitInterval>& means,
                               std::size_t tests) {
  std::vector<Estimate> estimates;
  for (const MeanInUnitInterval& each : means) {
    const double chance = is_stochastic(request) ? each.slack(static_cast<double>(tests)) : 0.0;
    estimates.push_back({each.mean(), measured_weight_step() + chance});
  }
  return estimates;
}

/// A straight edge, dark to light, drawn with every seed.
struct Edge {
  std::size_t side = 0;                    ///< of the images, in pixels
  std::vector<std::vector<float>> images;  ///< columns run across the edge
};

Edge draw_edge(const FilterRequest& request, Along along) {
  const glm::vec2 high = along == Along::kU ? glm::vec2(0.0f, kFar) : glm::vec2(kFar, 0.0f);
  AnalyticFloor floor(radius_of(request), {{glm::vec2(-kFar), high}});
  Edge edge{static_cast<std::size_t>(floor.pixels()), draw_seeds(floor.bench(), request, seeds_of(request))};
  if (along == Along::kU) return edge;
  for (std::vector<float>& image : edge.images) {
    for (std::size_t i = 0; i < image.size(); ++i)
      if (const std::size_t turned = i % edge.side * edge.side + i / edge.side; turned > i)
        std::swap(image[i], image[turned]);
  }
  return edge;
}

/// Gives visibility across an edge, by pixel.
std::vector<Estimate> measure_profile(const FilterRequest& request, Along along) {
  const Edge edge = draw_edge(request, along);
  std::vector<MeanInUnitInterval> across(edge.side);
  for (const std::vector<float>& image : edge.images)
    for (std::size_t i = 0; i < image.size(); ++i) across[i % edge.side].add(static_cast<double>(image[i]));
  return estimate(request, across, 2 * edge.side);
}

/// Gives the lit share of lines across an edge.
Estimate measure_light(const FilterRequest& request, Along along) {
  const Edge edge = draw_edge(request, along);
  MeanInUnitInterval lines;
  for (const std::vector<float>& image : edge.images) {
    for (auto line = image.begin(); line != image.end(); line += static_cast<std::ptrdiff_t>(edge.side)) {
      lines.add(std::accumulate(line, line + static_cast<std::ptrdiff_t>(edge.side), 0.0) /
                static_cast<double>(edge.side));
    }
  }
  return estimate(request, {lines}, 2).front();
}

/// An image in square cells: pixels of filters without chance, texels of stochastic ones, whose pixels say too little.
struct Cells {
  int side = 0;
  int per_texel = 1;
  std::vector<Estimate> values;
  const Estimate& at(int u, int v) const { return values[static_cast<std::size_t>(v * side + u)]; }
};

Cells draw_cells(const FilterRequest& request, const std::vector<Caster>& casters) {
  AnalyticFloor floor(radius_of(request), casters);
  const int pixels = floor.pixels(), cell = is_stochastic(request) ? kPixelsPerTexel : 1, side = pixels / cell;
  std::vector<MeanInUnitInterval> means(static_cast<std::size_t>(side * side));
  for (const std::vector<float>& image : draw_seeds(floor.bench(), request, seeds_of(request))) {
    for (int i = 0; i < pixels * pixels; ++i) {
      means[static_cast<std::size_t>((i / pixels / cell) * side + (i % pixels) / cell)].add(
          static_cast<double>(image[static_cast<std::size_t>(i)]));
    }
  }
  return {side, kPixelsPerTexel / cell, estimate(request, means, 3 * means.size())};
}

/// The corner of a wide caster, and a single blocked texel, whose shadow is the kernel itself.
std::vector<Caster> make_corner() { return {{glm::vec2(-kFar), {1.0f, 2.0f}}, {{2.0f, -3.0f}, {3.0f, -2.0f}}}; }

/// Expects of every cell what another image has elsewhere; `elsewhere` gives that place, or a place that is not there.
void expect_equal(const Cells& seen, const Cells& expected, const std::function<glm::ivec2(int, int)>& elsewhere) {
  int compared = 0, dark = 0, differing = 0;
  double worst = 0.0;
  for (int v = 0; v < seen.side; ++v) {
    for (int u = 0; u < seen.side; ++u) {
      const glm::ivec2 at = elsewhere(u, v);
      if (std::min(at.x, at.y) < 0 || std::max(at.x, at.y) >= seen.side) continue;
      const Estimate &a = seen.at(u, v), &b = expected.at(at.x, at.y);
      const double difference = std::abs(a.mean - b.mean);
      worst = std::max(worst, difference);
      differing += difference > a.slack + b.slack ? 1 : 0;
      dark += a.mean < 0.1 ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_EQ(differing, 0) << "of " << compared << " cells; the largest difference is " << worst;
  EXPECT_GT(dark, compared / 20) << "an image without shadow shows nothing";
}

/// Gives the kernel's positions along an axis, by its model; a filter without one has a symmetric kernel, as
/// filters/kernel.h asks.
std::vector<filters::Kernel::Atom> atoms_of(const FilterRequest& request) {
  const auto kernel = filters::find_kernel(request.spec, request.values);
  return kernel ? kernel->atoms() : std::vector<filters::Kernel::Atom>();
}

/// Gives the mean offset of the kernel along an axis, in texels; 0 for disks.
double kernel_mean(const FilterRequest& request) {
  double mean = 0.0;
  for (const filters::Kernel::Atom& atom : atoms_of(request)) mean += atom.weight * atom.offset;
  return mean;
}

bool is_symmetric(const FilterRequest& request) {
  const std::vector<filters::Kernel::Atom> atoms = atoms_of(request);
  return std::equal(atoms.begin(), atoms.end(), atoms.rbegin(), [](const auto& a, const auto& b) {
    return std::abs(a.offset + b.offset) < 1e-9 && std::abs(a.weight - b.weight) < 1e-9;
  });
}

class LinearKernel : public ::testing::TestWithParam<std::string> {
 protected:
  FilterRequest request() const { return request_of(GetParam()); }
};

TEST_P(LinearKernel, Edge_IsMonotone_FromDarkToLight) {
  for (const Along along : {Along::kU, Along::kV}) {
    const std::vector<Estimate> profile = measure_profile(request(), along);
    Estimate highest = profile.front();
    double fall = 0.0;
    for (const Estimate& each : profile) {
      fall = std::max(fall, highest.mean - highest.slack - (each.mean + each.slack));
      if (each.mean > highest.mean) highest = each;
    }
    EXPECT_EQ(fall, 0.0) << "visibility falls by that much more than chance and the weights' steps explain";
    EXPECT_LE(profile.front().mean, profile.front().slack);
    EXPECT_GE(profile.back().mean, 1.0 - profile.back().slack);
  }
}

/// A kernel takes as much light from one side of an edge as it gives to the other, but for its own mean offset.
TEST_P(LinearKernel, MeanLight_IsConserved) {
  const double texels = AnalyticFloor::view_texels(radius_of(request()));
  for (const Along along : {Along::kU, Along::kV}) {
    const Estimate lit = measure_light(request(), along);
    EXPECT_NEAR(lit.mean, 0.5 + kernel_mean(request()) / texels, lit.slack) << "of " << texels << " texels";
  }
}

TEST_P(LinearKernel, CasterOneTexelFurther_MovesTheShadowOneTexel) {
  const Cells still = draw_cells(request(), make_corner());
  for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
    std::vector<Caster> moved = make_corner();
    for (Caster& each : moved) {
      each.low += glm::vec2(step);
      each.high += glm::vec2(step);
    }
    const glm::ivec2 back = -step * still.per_texel;
    expect_equal(draw_cells(request(), moved), still, [&](int u, int v) { return glm::ivec2(u, v) + back; });
  }
}

/// Pixels keep off the places where ties are broken to one side (see kPixelsPerTexel). Kernels of an even number of
/// texels weigh their ends by where the receiver lies in its texel, and the mirror turns that, too. So nothing is
/// excepted but kernels that their model says are not symmetric.
TEST_P(LinearKernel, MirroredCaster_GivesTheMirroredImage) {
  if (!is_symmetric(request())) GTEST_SKIP() << "the kernel of its model is not symmetric";
  const Cells straight = draw_cells(request(), make_corner());
  for (const int axis : {0, 1}) {
    std::vector<Caster> mirrored = make_corner();
    for (Caster& each : mirrored) {
      const float low = each.low[axis];
      each.low[axis] = -each.high[axis];
      each.high[axis] = -low;
    }
    const int last = straight.side - 1;
    expect_equal(draw_cells(request(), mirrored), straight,
                 [&](int u, int v) { return axis == 0 ? glm::ivec2(last - u, v) : glm::ivec2(u, last - v); });
  }
}

INSTANTIATE_TEST_SUITE_P(AllFilters, LinearKernel,
                         ::testing::ValuesIn(ids_of({FilterKind::kComparison, FilterKind::kStochastic})), name_of);

}  // namespace
}  // namespace shadowbench::test
