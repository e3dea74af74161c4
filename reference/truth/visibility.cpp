#include "reference/truth/visibility.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "filters/random.h"

namespace shadowbench::truth {
namespace {

constexpr int kBits = 32;

/// The second dimension's direction numbers, of the primitive polynomial x + 1: Pascal's triangle modulo 2.
constexpr std::array<std::uint32_t, kBits> make_directions() {
  std::array<std::uint32_t, kBits> directions{};
  directions[0] = 1u << 31;
  for (int i = 1; i < kBits; ++i) {
    const std::uint32_t previous = directions[static_cast<std::size_t>(i - 1)];
    directions[static_cast<std::size_t>(i)] = previous ^ (previous >> 1);
  }
  return directions;
}

std::uint32_t reverse_bits(std::uint32_t x) {
  std::uint32_t reversed = 0;
  for (int i = 0; i < kBits; ++i) reversed |= ((x >> i) & 1u) << (kBits - 1 - i);
  return reversed;
}

std::uint32_t second_dimension(std::uint32_t index) {
  static constexpr std::array<std::uint32_t, kBits> kDirections = make_directions();
  std::uint32_t bits = 0;
  for (std::size_t i = 0; index; index >>= 1, ++i)
    if (index & 1u) bits ^= kDirections[i];
  return bits;
}

/// Flips each bit by a hash of the bits above it, which is what Owen's nested scrambling asks for.
std::uint32_t scramble(std::uint32_t bits, std::uint32_t seed) {
  std::uint32_t result = 0;
  for (int i = 0; i < kBits; ++i) {
    const std::uint32_t above = i == 0 ? 0u : bits >> (kBits - i);
    const std::uint32_t flip =
        filters::hash_bits(above ^ filters::hash_bits(seed + 0x9e3779b9u * static_cast<std::uint32_t>(i + 1))) & 1u;
    result |= (((bits >> (kBits - 1 - i)) & 1u) ^ flip) << (kBits - 1 - i);
  }
  return result;
}

/// Point `index` of the Sobol sequence's first two dimensions, Owen-scrambled by `seed`, as 32-bit fractions.
///
/// Different seeds give independent randomisations, each of them uniform: the mean over a scramble is unbiased, and
/// several scrambles give an honest standard error. XOR with random bits (a digital shift) keeps both properties and
/// makes a further randomisation cheaply. Cost: 64 hashes; keep the points.
/// Source: Sobol 1967; Owen 1995; scrambling by hashing after Burley 2020, Practical Hash-based Owen Scrambling, JCGT
/// 9(4).
glm::uvec2 sobol_bits(std::uint32_t index, std::uint32_t seed) {
  return {scramble(reverse_bits(index), filters::hash_bits(seed)),
          scramble(second_dimension(index), filters::hash_bits(seed ^ 0x85ebca6bu))};
}

/// The place of `index` in a shuffle that keeps every aligned run of 2^k indices together, so that a second pair of
/// dimensions, taken in this order, is as evenly spread as the first and independent of it. Source: Burley 2020,
/// section 5.
std::uint32_t shuffle_index(std::uint32_t index, std::uint32_t seed) {
  return scramble(index, filters::hash_bits(seed ^ 0xc2b2ae35u));  // a bit depends on the bits above it only
}

/// Reads 32-bit fractions as a point of [0,1)^2.
glm::dvec2 to_unit_square(glm::uvec2 bits) { return {bits.x * 0x1p-32, bits.y * 0x1p-32}; }

/// Two pairs of dimensions of one point.
struct Bits {
  glm::uvec2 first;
  glm::uvec2 second;
};

std::uint32_t mix(std::uint32_t a, std::uint32_t b) { return filters::hash_bits(a + filters::hash_bits(b)); }

std::vector<Bits> make_scramble(int max_points, std::uint32_t seed) {
  std::vector<Bits> points;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(max_points); ++i)
    points.push_back({sobol_bits(i, seed), sobol_bits(shuffle_index(i, seed), mix(seed, 1))});
  return points;
}

/// The rays of one receiver: origin and direction are affine in a sample's offset, but for those to a sphere.
struct RayFan {
  glm::vec3 origin{0.0f};
  glm::vec3 origin_x{0.0f};
  glm::vec3 origin_y{0.0f};
  glm::vec3 direction{0.0f};
  glm::vec3 direction_x{0.0f};
  glm::vec3 direction_y{0.0f};
  glm::vec3 normal{0.0f};       ///< rays below this plane are blocked
  glm::vec3 light_axis{0.0f};   ///< of a flat light, unit length: its rays are weighed by what they would bring
  bool weighs = false;          ///< rays are weighed; without an axis they are evenly spread over solid angle
  float reach = 0.0f;           ///< in units of a direction's length
  float cap = 0.0f;             ///< above 0: rays to a sphere, which fills a cone; 1 - cos of half its angle, below 1
  float scale = 0.0f;           ///< of the second samples, which are added to the first ones
  bool origin_moves = true;     ///< false: origin_x and origin_y are 0
  bool direction_moves = true;  ///< false: direction_x and direction_y are 0
};

/// Makes the fan of one receiver, an index into ReceiverImage::points.
using MakeFan = std::function<RayFan(std::size_t)>;

/// An edge is not judged by fewer points per scramble: small counts make small standard errors by chance.
constexpr int kEdgePoints = 16;
/// What doubling its points makes of an edge's standard error: 2^-0.75, as stratified points have it across a smooth
/// edge. Where it is something else, pixels stop earlier or later; the standard errors that are stored do not depend on
/// it.
constexpr double kGainOfDoubling = 0.5946;

constexpr int kTileSide = 16;

/// Transmittances that differ by less differ by the order of their factors.
constexpr float kSameTransmittance = 1e-6f;

/// Of transmittances, each of 24 bits: exact.
using Sums = std::array<double, kScrambles>;

/// Writes base + x * along_x + y * along_y, lane by lane.
void write_lanes(RayPacket::Lanes& to, float base, float along_x, float along_y, const SampleSets::Lanes& offsets) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = base + offsets.x[i] * along_x + offsets.y[i] * along_y;
}

/// Writes the ways to the near side of a sphere, spread evenly over the directions that it fills by Lambert's azimuthal
/// equal-area map of the unit disk. The fan's direction leads to the centre; those across it are sqrt(2 cap) as long.
void write_cap(std::array<RayPacket::Lanes, 3>& to, const RayFan& fan, const SampleSets::Lanes& offsets) {
  for (std::size_t i = 0; i < offsets.x.size(); ++i) {
    const float x = offsets.x[i], y = offsets.y[i];
    const float rise = fan.cap * std::min(x * x + y * y, 1.0f), cosine = 1.0f - rise;
    const float root = std::sqrt((fan.cap - rise) * (2.0f - fan.cap - rise));  // of sin^2 of the cone less the ray's
    const float length = (1.0f - fan.cap) * (1.0f - fan.cap) / (cosine + root), across = std::sqrt(1.0f - 0.5f * rise);
    for (int axis = 0; axis < 3; ++axis)
      to[static_cast<std::size_t>(axis)][i] =
          length * (cosine * fan.direction[axis] + across * (x * fan.direction_x[axis] + y * fan.direction_y[axis]));
  }
}

/// What the rays of each scramble would bring to a receiver, in any unit, and what arrives of it.
struct Arrival {
  std::array<float, kScrambles> sent{};
  std::array<float, kScrambles> arrived{};
};

/// Traces a fan's points, one packet of all scrambles for each, and adds up what arrives from the light.
class FanTracer {
 public:
  explicit FanTracer(const RayFan& fan) : fan_(fan) {
    static constexpr SampleSets::Lanes kCentre{};
    write(kCentre, packet_.origin, fan.origin, fan.origin_x, fan.origin_y);
    write(kCentre, packet_.direction, fan.direction, fan.direction_x, fan.direction_y);
    find_active();
  }

  void trace(const Occluders& occluders, const SampleSets::Lanes& offsets, const TraceSettings& settings) {
    if (fan_.origin_moves) write(offsets, packet_.origin, fan_.origin, fan_.origin_x, fan_.origin_y);
    if (fan_.direction_moves) {
      if (fan_.cap > 0.0f)
        write_cap(packet_.direction, fan_, offsets);
      else
        write(offsets, packet_.direction, fan_.direction, fan_.direction_x, fan_.direction_y);
      find_active();
    }
    packet_.reach.fill(fan_.reach);
    if (settings.on_packet) settings.on_packet(packet_);
    occluders.find_blocked(packet_);
    for (std::size_t s = 0; s < lit_.size(); ++s) {
      const float arrives = packet_.active[s] != 0 ? packet_.transmittance[s] : 0.0f;
      lit_[s] += static_cast<double>(arrives);
      least_[s] = std::min(least_[s], arrives);
      most_[s] = std::max(most_[s], arrives);
    }
    if (fan_.weighs) weigh();
  }

  const Sums& lit() const { return lit_; }

  /// By how much the rays differ, 0 .. 1; 0 where all agree.
  double spread() const {
    const float spread = *std::ranges::max_element(most_) - *std::ranges::min_element(least_);
    return spread > kSameTransmittance ? static_cast<double>(spread) : 0.0;
  }

  const Arrival& arrival() const { return arrival_; }

 private:
  const RayFan& fan_;
  RayPacket packet_;
  Sums lit_{};
  RayPacket::Lanes least_ = RayPacket::every(1.0f);
  RayPacket::Lanes most_{};
  Arrival arrival_;

  static void write(const SampleSets::Lanes& offsets, std::array<RayPacket::Lanes, 3>& to, const glm::vec3& base,
                    const glm::vec3& along_x, const glm::vec3& along_y) {
    for (int axis = 0; axis < 3; ++axis)
      write_lanes(to[static_cast<std::size_t>(axis)], base[axis], along_x[axis], along_y[axis], offsets);
  }

  /// Rays below the receiver's own plane are blocked by it.
  void find_active() {
    const auto& d = packet_.direction;
    for (std::size_t i = 0; i < packet_.active.size(); ++i) {
      const float above = d[0][i] * fan_.normal.x + d[1][i] * fan_.normal.y + d[2][i] * fan_.normal.z;
      packet_.active[i] = above > 0.0f ? -1 : 0;
    }
  }

  /// By the receiver's cosine, and for points of a flat light by its own cosine over the distance squared.
  void weigh() {
    const auto& d = packet_.direction;
    const bool is_flat = fan_.light_axis != glm::vec3(0.0f);
    for (std::size_t i = 0; i < lit_.size(); ++i) {
      const glm::vec3 way(d[0][i], d[1][i], d[2][i]);
      const float squared = glm::dot(way, way), cosine = std::max(0.0f, glm::dot(way, fan_.normal));
      const float weight = is_flat ? cosine * std::abs(glm::dot(way, fan_.light_axis)) / (squared * squared)
                                   : cosine / std::sqrt(squared);
      arrival_.sent[i] += weight;
      arrival_.arrived[i] += packet_.reach[i] < 0.0f ? 0.0f : packet_.transmittance[i] * weight;
    }
  }
};

class AdaptiveTracer {
 public:
  AdaptiveTracer(const Occluders& occluders, const ReceiverImage& receivers, const SampleSets& samples,
                 const TraceSettings& settings, const MakeFan& make_fan, const SampleSets* scaled)
      : occluders_(occluders),
        receivers_(receivers),
        samples_(samples),
        settings_(settings),
        make_fan_(make_fan),
        scaled_(scaled) {}

  TracedVisibility run() {
    const std::size_t pixels = receivers_.points.size();
    truth_.visibility.assign(pixels, 1.0f);
    truth_.standard_error.assign(pixels, 0.0f);
    truth_.unanimous.assign(pixels, 1);
    truth_.rays.assign(pixels, 0);
    truth_.ratio.assign(pixels, 1.0f);
    truth_.ratio_error.assign(pixels, 0.0f);
    truth_.variance.assign(pixels, 0.0f);
    for_each_receiver([&](std::size_t i) { trace(i, kFirstPoints, kFirstPoints); });
    const std::vector<float> first = truth_.visibility;
    for_each_receiver([&](std::size_t i) {
      if (is_settled(first, static_cast<int>(i))) return;
      if (has_edges_)
        trace(i, kEdgePoints, samples_.max_points());
      else
        ++truth_.rays[i];
    });
    return std::move(truth_);
  }

 private:
  const Occluders& occluders_;
  const ReceiverImage& receivers_;
  const SampleSets& samples_;
  const TraceSettings& settings_;
  const MakeFan& make_fan_;
  const SampleSets* scaled_;
  const bool has_edges_ = samples_.max_points() >= kEdgePoints;
  TracedVisibility truth_;

  /// Calls `work` with the pixels that count, in tiles, because rays of neighbouring pixels visit the same parts of the
  /// scene.
  template <class Work>
  void for_each_receiver(Work work) {
    const int width = receivers_.width, height = receivers_.height;
    const tbb::blocked_range2d<int> all(0, height, kTileSide, 0, width, kTileSide);
    tbb::parallel_for(
        all,
        [&](const tbb::blocked_range2d<int>& tile) {
          for (int y = tile.rows().begin(); y < tile.rows().end(); ++y) {
            for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) {
              const std::size_t i =
                  static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
              if (receivers_.points[i].counts) work(i);
            }
          }
        },
        tbb::simple_partitioner());
  }

  /// Whether a pixel and those of its neighbours that count all see the whole light, or all see nothing of it. What is
  /// dimmed is traced on, since a mean does not say whether all rays agree.
  bool is_settled(const std::vector<float>& first, int i) const {
    const int x = i % receivers_.width, y = i / receivers_.width;
    const float own = first[static_cast<std::size_t>(i)];
    if (own != 0.0f && own != 1.0f) return false;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, receivers_.height - 1); ++ny) {
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, receivers_.width - 1); ++nx) {
        const auto n = static_cast<std::size_t>(ny * receivers_.width + nx);
        if (receivers_.points[n].counts && first[n] != own) return false;
      }
    }
    return true;
  }

  /// Traces at least `least` and at most `most` points per scramble, doubling until the first half of them foretells a
  /// standard error that is small enough. The one that is stored does not decide: a pixel would stop where its estimate
  /// is small by chance.
  void trace(std::size_t pixel, int least, int most) {
    const RayFan fan = make_fan_(pixel);
    const std::uint32_t key = static_cast<std::uint32_t>(pixel) + filters::hash_bits(settings_.seed);
    const int set = static_cast<int>(filters::hash_bits(key) % SampleSets::kSets);
    FanTracer tracer(fan);
    double foretold = HUGE_VAL;
    for (int points = least / 2, traced = 0;; points *= 2) {
      for (; traced < points; ++traced) tracer.trace(occluders_, offsets_of(fan, set, traced), settings_);
      const double error = conclude(pixel, tracer, points);
      if (fan.weighs) conclude(pixel, tracer.arrival());
      if (points == most || (points >= least && foretold <= settings_.standard_error)) return;
      if (settings_.standard_error >= 1.0 && tracer.spread() > 0.0) return;
      foretold = kGainOfDoubling * error;
    }
  }

  SampleSets::Lanes offsets_of(const RayFan& fan, int set, int point) const {
    SampleSets::Lanes offsets = samples_.at(set, point);
    if (fan.scale == 0.0f) return offsets;
    const SampleSets::Lanes& more = scaled_->at(set, point);
    for (std::size_t i = 0; i < offsets.x.size(); ++i) {
      offsets.x[i] += fan.scale * more.x[i];
      offsets.y[i] += fan.scale * more.y[i];
    }
    return offsets;
  }

  /// Stores mean and standard error over the scrambles, and returns the standard error.
  double conclude(std::size_t pixel, const FanTracer& tracer, int points) {
    const Sums& lit = tracer.lit();
    const double mean = std::accumulate(lit.begin(), lit.end(), 0.0) / points / kScrambles;
    double squares = 0.0;
    for (const double sum : lit) {
      const double deviation = sum / points - mean;
      squares += deviation * deviation;
    }
    // Stratified scrambles often have the same sum although none is exact: a deviation of one point is assumed on top.
    const double spread = tracer.spread(), presumed = (spread > 0.0 ? spread : 1.0) / points;
    const double error = std::sqrt((squares + presumed * presumed) / (kScrambles - 1) / kScrambles);
    const bool unanimous = spread == 0.0;
    truth_.visibility[pixel] = static_cast<float>(mean);
    truth_.rays[pixel] = static_cast<std::uint32_t>(kScrambles * points);
    truth_.unanimous[pixel] = unanimous ? 1 : 0;
    truth_.standard_error[pixel] = unanimous ? 0.0f : static_cast<float>(error);
    truth_.variance[pixel] = unanimous ? 0.0f : static_cast<float>(squares / (kScrambles - 1) / kScrambles);
    return error;
  }

  /// Stores the share that arrives, a ratio of sums, with the standard error of its linearisation over the scrambles
  /// (Cochran 1977, Sampling Techniques, section 6.4). Where nothing was sent, nothing arrives.
  void conclude(std::size_t pixel, const Arrival& arrival) {
    const double sent = std::accumulate(arrival.sent.begin(), arrival.sent.end(), 0.0);
    const double arrived = std::accumulate(arrival.arrived.begin(), arrival.arrived.end(), 0.0);
    const double ratio = sent > 0.0 ? arrived / sent : 0.0;
    double squares = 0.0;
    for (std::size_t s = 0; s < kScrambles; ++s) {
      const double deviation = static_cast<double>(arrival.arrived[s]) - ratio * static_cast<double>(arrival.sent[s]);
      squares += deviation * deviation;
    }
    const double mean = sent / kScrambles;
    truth_.ratio[pixel] = static_cast<float>(ratio);
    truth_.ratio_error[pixel] =
        sent > 0.0 ? static_cast<float>(std::sqrt(squares / (kScrambles - 1) / kScrambles) / mean) : 0.0f;
  }
};

/// Traces every receiver's fan over the same sample sets; see trace_area() for when a pixel stops. Fans with a scale
/// need `scaled`, second samples of as many points.
TracedVisibility trace_fans(const Occluders& occluders, const ReceiverImage& receivers, const SampleSets& samples,
                            const TraceSettings& settings, const MakeFan& make_fan,
                            const SampleSets* scaled = nullptr) {
  assert(std::has_single_bit(static_cast<unsigned>(samples.max_points())));
  assert(samples.max_points() == kFirstPoints || samples.max_points() >= kEdgePoints);
  return AdaptiveTracer(occluders, receivers, samples, settings, make_fan, scaled).run();
}

/// Steps of one texel on a receiver's plane.
struct Steps {
  glm::dvec3 right;
  glm::dvec3 up;
};

Steps step_along_texels(const TexelGradients& along, const glm::dvec3& normal) {
  const double area = glm::dot(normal, glm::cross(along.u, along.v));
  return {glm::cross(along.v, normal) / area, glm::cross(normal, along.u) / area};
}

/// A kernel's fan: rays to the light's centre that start on the receiver's tangent plane, below the texels that they
/// stand for.
RayFan make_kernel_fan(const Occluders& occluders, const ReceiverPoint& point, const MapGrid& grid, double half_width) {
  const glm::dvec3 normal(point.normal_ws), position(point.position_ws);
  const glm::dvec3 to_light = grid.lamp ? grid.lamp->position_ws - position : grid.to_light;
  const double texel_ws =
      grid.lamp ? grid.texel_size_ws * glm::dot(to_light, grid.to_light) / grid.lamp->reference_m : grid.texel_size_ws;
  const double n_dot_l = glm::dot(normal, to_light);
  // A step of one texel, slid along the light until it lies in the plane.
  const auto slide = [&](const glm::dvec3& axis) {
    return texel_ws * (axis - to_light * (glm::dot(normal, axis) / n_dot_l));
  };
  const auto [right, up] = grid.curved ? step_along_texels(grid.curved->gradients(position), normal)
                                       : Steps{slide(grid.right), slide(grid.up)};
  RayFan fan;
  fan.origin = occluders.offset_origin(point.position_ws, point.normal_ws,
                                       static_cast<float>(half_width * (glm::length(right) + glm::length(up))));
  fan.origin_x = right;
  fan.origin_y = up;
  fan.direction = grid.to_light;
  fan.normal = point.normal_ws;
  fan.reach = std::numeric_limits<float>::infinity();
  fan.direction_moves = false;
  if (!grid.lamp) return fan;
  fan.direction = grid.lamp->position_ws - glm::dvec3(fan.origin);
  fan.direction_x = -fan.origin_x;
  fan.direction_y = -fan.origin_y;
  fan.direction_moves = true;
  fan.reach = 1.0f;
  return fan;
}

/// Calls `work` with up to a packet's number of receivers that count, row by row.
template <class Work>
void for_each_group(const ReceiverImage& receivers, Work work) {
  tbb::parallel_for(
      0, receivers.height,
      [&](int y) {
        std::vector<std::size_t> group;
        for (int x = 0; x < receivers.width; ++x) {
          const std::size_t i =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(receivers.width) + static_cast<std::size_t>(x);
          if (receivers.points[i].counts) group.push_back(i);
          const bool is_last = x + 1 == receivers.width;
          if (group.size() < RayPacket::kSize && !(is_last && !group.empty())) continue;
          work(group);
          group.clear();
        }
      });
}

}  // namespace

SampleSets::SampleSets(int max_points, std::uint32_t seed, const Mapping& mapping)
    : max_points_(max_points), lanes_(static_cast<std::size_t>(kSets) * static_cast<std::size_t>(max_points)) {
  std::vector<std::vector<Bits>> scrambles(kScrambles);
  tbb::parallel_for(
      0, kScrambles,
      [&](int s) {
        scrambles[static_cast<std::size_t>(s)] = make_scramble(max_points, mix(static_cast<std::uint32_t>(s), seed));
      });
  tbb::parallel_for(0, kSets, [&](int set) {
    for (std::size_t s = 0; s < scrambles.size(); ++s) {
      const std::uint32_t key =
          mix(static_cast<std::uint32_t>(set) * kScrambles + static_cast<std::uint32_t>(s), ~seed);
      const glm::uvec2 shift(mix(key, 1), mix(key, 2)), other_shift(mix(key, 3), mix(key, 4));
      for (int i = 0; i < max_points; ++i) {
        const Bits& bits = scrambles[s][static_cast<std::size_t>(i)];
        const glm::dvec2 offset =
            mapping(to_unit_square(bits.first ^ shift), to_unit_square(bits.second ^ other_shift));
        Lanes& lanes =
            lanes_[static_cast<std::size_t>(set) * static_cast<std::size_t>(max_points) + static_cast<std::size_t>(i)];
        lanes.x[s] = static_cast<float>(offset.x);
        lanes.y[s] = static_cast<float>(offset.y);
      }
    }
  });
}

TracedVisibility trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                            const TraceSettings& settings) {
  return trace_area(occluders, receivers, light, settings, make_light_samples(light, settings));
}

SampleSets make_light_samples(const AreaLight& light, const TraceSettings& settings) {
  return {settings.max_points, settings.seed,
          [&](const glm::dvec2& u, const glm::dvec2&) { return light.map_sample(u); }};
}

TracedVisibility trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                            const TraceSettings& settings, const SampleSets& samples) {
  return trace_fans(
      occluders, receivers, samples, settings,
      [&](std::size_t i) {
        const ReceiverPoint& point = receivers.points[i];
        RayFan fan;
        fan.origin = occluders.offset_origin(point.position_ws, point.normal_ws);
        fan.direction = light.centre_direction(glm::dvec3(fan.origin));
        const AreaLight::Aim aim = light.aim(glm::dvec3(fan.origin));
        fan.direction_x = aim.u;
        fan.direction_y = aim.v;
        fan.cap = aim.cap;
        fan.normal = point.normal_ws;
        fan.light_axis = light.axis();
        fan.weighs = true;
        fan.reach = light.reach();
        fan.origin_moves = false;
        if (aim.cap < 1.0f) return fan;
        // Inside a sphere: the rays end where they start.
        fan.direction = point.normal_ws;
        fan.direction_moves = false;
        fan.reach = 0.0f;
        return fan;
      });
}

TracedVisibility trace_kernel(const Occluders& occluders, const ReceiverImage& receivers, const filters::Kernel& kernel,
                              const MapGrid& grid, const TraceSettings& settings) {
  const SampleSets samples(
      settings.max_points, settings.seed,
      [&](const glm::dvec2& shape, const glm::dvec2& between) { return kernel.sample(shape, between); });
  return trace_fans(occluders, receivers, samples, settings, [&](std::size_t i) {
    return make_kernel_fan(occluders, receivers.points[i], grid, kernel.half_width());
  });
}

TracedVisibility trace_disks(const Occluders& occluders, const ReceiverImage& receivers,
                             std::span<const float> radii_texels, const MapGrid& grid, const TraceSettings& settings) {
  const filters::Kernel fetch = filters::Kernel::make_point(filters::Reconstruction::kBilinear);
  const SampleSets fetches(
      settings.max_points, settings.seed,
      [&](const glm::dvec2& disk, const glm::dvec2& between) { return fetch.sample(disk, between); });
  const SampleSets disks(settings.max_points, settings.seed,
                         [](const glm::dvec2& disk, const glm::dvec2&) { return filters::map_to_disk(disk); });
  const auto make_fan = [&](std::size_t i) {
    const double half_width = fetch.half_width() + static_cast<double>(radii_texels[i]);
    RayFan fan = make_kernel_fan(occluders, receivers.points[i], grid, half_width);
    fan.scale = radii_texels[i];
    return fan;
  };
  return trace_fans(occluders, receivers, fetches, settings, make_fan, &disks);
}

TracedVisibility trace_square(const Occluders& occluders, const ReceiverImage& receivers, double half_width_texels,
                              const MapGrid& grid, const TraceSettings& settings) {
  const SampleSets samples(
      settings.max_points, settings.seed,
      [&](const glm::dvec2& u, const glm::dvec2&) { return half_width_texels * (2.0 * u - 1.0); });
  return trace_fans(occluders, receivers, samples, settings, [&](std::size_t i) {
    return make_kernel_fan(occluders, receivers.points[i], grid, half_width_texels);
  });
}

std::vector<float> trace_hard(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light) {
  std::vector<float> visibility(receivers.points.size(), 1.0f);
  for_each_group(receivers, [&](const std::vector<std::size_t>& group) {
    RayPacket packet;
    for (std::size_t lane = 0; lane < group.size(); ++lane) {
      const ReceiverPoint& point = receivers.points[group[lane]];
      const glm::vec3 origin = occluders.offset_origin(point.position_ws, point.normal_ws);
      const glm::vec3 direction = light.centre_direction(glm::dvec3(origin));
      packet.set(lane, origin, direction, light.reach());
      if (!(glm::dot(direction, point.normal_ws) > 0.0f)) packet.active[lane] = 0;  // below the receiver's own plane
    }
    occluders.find_blocked(packet);
    for (std::size_t lane = 0; lane < group.size(); ++lane)
      visibility[group[lane]] = packet.active[lane] != 0 ? packet.transmittance[lane] : 0.0f;
  });
  return visibility;
}

std::vector<float> trace_first_blockers(const Occluders& occluders, const ReceiverImage& receivers,
                                        const AreaLight& light) {
  std::vector<float> distances(receivers.points.size(), std::numeric_limits<float>::infinity());
  for_each_group(receivers, [&](const std::vector<std::size_t>& group) {
    RayPacket packet;
    RayPacket::Lanes lengths{};
    for (std::size_t lane = 0; lane < group.size(); ++lane) {
      const ReceiverPoint& point = receivers.points[group[lane]];
      const glm::vec3 origin = occluders.offset_origin(point.position_ws, point.normal_ws);
      // The ray starts at the light, or beyond everything, and runs back to the receiver.
      const glm::vec3 to_light(light.centre_direction(glm::dvec3(origin)));
      const bool is_lamp = std::isfinite(light.reach());
      lengths[lane] = is_lamp ? glm::length(to_light) : 1.01f * (glm::length(origin) + occluders.farthest());
      const glm::vec3 way = is_lamp ? to_light : to_light * lengths[lane];
      packet.set(lane, origin + way, -way, 1.0f);
    }
    const RayPacket::Lanes hits = occluders.find_nearest(packet).distances;
    for (std::size_t lane = 0; lane < group.size(); ++lane)
      if (std::isfinite(hits[lane])) distances[group[lane]] = lengths[lane] * (1.0f - hits[lane]);
  });
  return distances;
}

}  // namespace shadowbench::truth
