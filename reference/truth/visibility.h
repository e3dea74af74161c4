#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "filters/kernel.h"
#include "reference/truth/area_light.h"
#include "reference/truth/occluders.h"

namespace shadowbench::truth {

/// The number of independent scrambles; a standard error over them has one degree of freedom less.
inline constexpr int kScrambles = RayPacket::kSize;

/// Low-discrepancy points, mapped once to where rays go: 16 randomisations, of which each pixel takes one by a hash of
/// its place, each with 16 independent scrambles side by side as the lanes of a packet.
///
/// Each scramble is a Sobol sequence of its own Owen scrambling; the randomisations differ by digital shifts, which
/// keep it uniform. The first 4^k points of a scramble are evenly spread.
class SampleSets {
 public:
  static constexpr int kSets = 16;

  /// Maps two independent points of [0,1)^2 to an offset.
  using Mapping = std::function<glm::dvec2(const glm::dvec2& first, const glm::dvec2& second)>;

  /// One point of every scramble.
  struct Lanes {
    alignas(64) RayPacket::Lanes x;
    alignas(64) RayPacket::Lanes y;
  };

  /// Cost: 16 * 16 * `max_points` mappings, 128 bytes for every 16 of them.
  SampleSets(int max_points, std::uint32_t seed, const Mapping& mapping);

  const Lanes& at(int set, int point) const {
    return lanes_[static_cast<std::size_t>(set) * static_cast<std::size_t>(max_points_) +
                  static_cast<std::size_t>(point)];
  }

  int max_points() const { return max_points_; }

 private:
  int max_points_;
  std::vector<Lanes> lanes_;  ///< set by set
};

/// A receiver point of the G-buffer.
struct ReceiverPoint {
  glm::vec3 position_ws{0.0f};
  glm::vec3 normal_ws{0.0f, 1.0f, 0.0f};  ///< geometric, unit length, flipped to the viewer
  bool counts = false;                    ///< false: background, or turned away from the light; not traced
};

/// Receivers as an image, row by row.
struct ReceiverImage {
  int width = 0;
  int height = 0;
  std::vector<ReceiverPoint> points;  ///< width * height
  std::string content = {};           ///< a name for these points, by which a cache knows them; may be empty
};

/// How sure a traced fraction is to be.
struct TraceSettings {
  /// Wanted for every pixel that is not unanimous; some get a little more or less. 1: all that is asked of a pixel is
  /// whether its rays agree.
  double standard_error = 0.005;
  int max_points = 1024;  ///< per scramble; a power of two, at least 16, or 4: first points are all that is traced
  std::uint32_t seed = 1;
  std::function<void(const RayPacket&)> on_packet = {};  ///< hears of every packet, from many threads; for measurement
};

/// A traced fraction of rays at every receiver; 1 lit, 0 blocked, 1 where a point does not count. A ray that surfaces
/// dim counts for what is left of it.
struct TracedVisibility {
  std::vector<float> visibility;
  std::vector<float> standard_error;    ///< of the mean over the scrambles; 0 where all rays agree, see `unanimous`
  std::vector<std::uint8_t> unanimous;  ///< all rays of this pixel agree; the truth lies within 3 / rays of them (95 %)
  /// Traced for this pixel; 64: its neighbours agree with it too. One too many where first points are all that is
  /// traced and they do not.
  std::vector<std::uint32_t> rays;
  /// Of an area light, shadowed over unshadowed light: the share of what it would bring that arrives, which weighs each
  /// of its points by the cosine at the receiver, the cosine at the light and the inverse squared distance. Of kernels
  /// 1, or empty from the cache.
  std::vector<float> ratio = {};
  std::vector<float> ratio_error = {};  ///< its standard error
  /// Of `visibility` as an estimate, without bias: `standard_error` assumes a deviation of one point on top.
  std::vector<float> variance = {};
};

/// Every pixel's, per scramble.
inline constexpr int kFirstPoints = 4;

/// The number of rays of a pixel that agrees with its neighbours.
inline constexpr std::uint32_t kRaysOfSettledPixel = kFirstPoints * kScrambles;

/// Traces the fraction of an area light that each receiver sees.
///
/// Every pixel starts with 4 points from each of 16 Owen-scrambled Sobol sequences, and stops there when all its rays
/// and those of its eight neighbours agree. The others go on with 16 points per sequence and double them until the
/// spread of the scrambles at half the points foretells a standard error that is small enough, or `max_points` is
/// reached. The part of the light below a receiver's own plane is blocked by it, and would bring nothing. The result
/// depends on neither the number of threads nor the order of pixels. Cost: 64 rays for a pixel away from edges, up to
/// 16 * max_points at one.
TracedVisibility trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                            const TraceSettings& settings);

/// The points of a light that trace_area() sends rays to, the same for all lights of one shape. Cost: 0.05 s of one
/// core.
SampleSets make_light_samples(const AreaLight& light, const TraceSettings& settings);

/// The same with these samples of make_light_samples(), for whoever traces often.
TracedVisibility trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                            const TraceSettings& settings, const SampleSets& samples);

/// How a point's place in a map changes with its place in the world: texels for each metre.
struct TexelGradients {
  glm::dvec3 u;
  glm::dvec3 v;
};

/// The texel grid of a light's map, which says where a kernel lies in the world.
struct MapGrid {
  glm::dvec3 to_light{0.0, 1.0, 0.0};  ///< unit length
  glm::dvec3 right{1.0, 0.0, 0.0};     ///< one texel in u is `texel_size_ws` metres along it; unit length
  glm::dvec3 up{0.0, 0.0, 1.0};        ///< the same for v
  double texel_size_ws = 1.0;          ///< metres; of a lamp's map at `Lamp::reference_m`

  /// Of a perspective map: the texels grow with the distance along the axis, which `to_light` points against.
  struct Lamp {
    glm::dvec3 position_ws{0.0};
    double reference_m = 1.0;
  };
  std::optional<Lamp> lamp = {};  ///< none: rays are parallel to `to_light`

  /// Of a map whose texels differ in shape: these, at a point, in place of `right`, `up` and `texel_size_ws`.
  struct Curved {
    std::function<TexelGradients(const glm::dvec3& point_ws)> gradients;
    std::string name;  ///< tells it from all others
  };
  std::optional<Curved> curved = {};
};

/// Traces the fraction of a kernel, centred on each receiver and projected along the light onto its tangent plane, from
/// which the light's centre is seen: the filter with an ideal map and an ideal receiver-plane bias. The kernel's
/// texels on that plane are taken to be as large as at the receiver, and of the same shape.
/// Adaptive like trace_area(), at the same cost.
TracedVisibility trace_kernel(const Occluders& occluders, const ReceiverImage& receivers, const filters::Kernel& kernel,
                              const MapGrid& grid, const TraceSettings& settings);

/// The same where every receiver has a disk of its own, read bilinearly: Kernel::make_disk() of its radius, 0 included.
/// Requires a radius for each receiver.
TracedVisibility trace_disks(const Occluders& occluders, const ReceiverImage& receivers,
                             std::span<const float> radii_texels, const MapGrid& grid, const TraceSettings& settings);

/// The same for a uniform square of this half-width in texels.
TracedVisibility trace_square(const Occluders& occluders, const ReceiverImage& receivers, double half_width_texels,
                              const MapGrid& grid, const TraceSettings& settings);

/// Traces one ray from each receiver to the light's centre: 1 seen, 0 blocked, between them what surfaces that dim
/// leave of it, 1 where a point does not count.
std::vector<float> trace_hard(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light);

/// Returns how far from each receiver, towards the light, the surface lies that the light meets first, one that dims
/// included; metres. An ideal depth map would hold that surface. Infinity where nothing blocks the light and where a
/// point does not count.
std::vector<float> trace_first_blockers(const Occluders& occluders, const ReceiverImage& receivers,
                                        const AreaLight& light);

}  // namespace shadowbench::truth
