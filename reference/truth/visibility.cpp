#include "reference/truth/visibility.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

#include "filters/random.h"
#include "reference/truth/sobol.h"

namespace shadowbench::reference {
namespace {

constexpr int kFirstPoints = 4;
/// An edge is not judged by fewer points per scramble: small counts make small standard errors by chance.
constexpr int kEdgePoints = 16;

/// Packs rays of one receiver until a packet is full, whatever scramble they belong to; counts those that reach the
/// light, per scramble.
class RayQueue {
 public:
  RayQueue(const Occluders& occluders, const AreaLight& light, const ReceiverPoint& point)
      : occluders_(occluders), normal_(point.normal_ws), origin_(occluders.offset_origin(point.position_ws, point.normal_ws)) {
    packet_.reach = light.reach();
  }

  glm::dvec3 origin() const { return glm::dvec3(origin_); }

  void add(const glm::dvec3& direction, int scramble) {
    if (glm::dot(direction, glm::dvec3(normal_)) <= 0.0) return;  // below the receiver's own plane
    const auto i = static_cast<std::size_t>(packet_.count++);
    packet_.origins[i] = origin_;
    packet_.directions[i] = glm::vec3(direction);
    scrambles_[i] = scramble;
    if (packet_.count == RayPacket::kSize) flush();
  }

  /// Traces what is left; gives the counts since the queue was made.
  const std::array<int, kScrambles>& finish() {
    if (packet_.count > 0) flush();
    return lit_;
  }

 private:
  const Occluders& occluders_;
  glm::vec3 normal_;
  glm::vec3 origin_;
  RayPacket packet_;
  std::array<int, RayPacket::kSize> scrambles_{};
  std::array<int, kScrambles> lit_{};

  void flush() {
    const std::uint32_t blocked = occluders_.find_blocked(packet_);
    for (int i = 0; i < packet_.count; ++i) {
      if (!(blocked >> i & 1u)) ++lit_[static_cast<std::size_t>(scrambles_[static_cast<std::size_t>(i)])];
    }
    packet_.count = 0;
  }
};

class AreaTracer {
 public:
  AreaTracer(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
             const AreaSettings& settings)
      : occluders_(occluders), receivers_(receivers), light_(light), settings_(settings) {
    for (int s = 0; s < kScrambles; ++s) {
      for (int i = 0; i < settings.max_points; ++i) {
        points_.push_back(sobol_bits(static_cast<std::uint32_t>(i),
                                     filters::hash_bits(settings.seed * kScrambles + static_cast<std::uint32_t>(s))));
      }
    }
  }

  AreaTruth run() {
    const std::size_t pixels = receivers_.points.size();
    truth_.visibility.assign(pixels, 1.0f);
    truth_.standard_error.assign(pixels, 0.0f);
    truth_.unanimous.assign(pixels, 1);
    truth_.rays.assign(pixels, 0);
    for_each_receiver([this](std::size_t i) { trace(i, kFirstPoints, kFirstPoints); });
    const std::vector<float> first = truth_.visibility;
    for_each_receiver([&](std::size_t i) {
      if (!is_settled(first, static_cast<int>(i))) trace(i, kEdgePoints, settings_.max_points);
    });
    return std::move(truth_);
  }

 private:
  const Occluders& occluders_;
  const ReceiverImage& receivers_;
  const AreaLight& light_;
  const AreaSettings& settings_;
  std::vector<glm::uvec2> points_;  // scramble by scramble
  AreaTruth truth_;

  template <class Work>
  void for_each_receiver(Work work) {
    tbb::parallel_for(0, receivers_.height, [&](int y) {
      for (int x = 0; x < receivers_.width; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(receivers_.width) + static_cast<std::size_t>(x);
        if (receivers_.points[i].counts) work(i);
      }
    });
  }

  /// A pixel and its neighbours that count see all of the light, or all see none of it.
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

  /// Traces at least `least` and at most `most` points per scramble, doubling until the standard error is small enough.
  void trace(std::size_t pixel, int least, int most) {
    RayQueue queue(occluders_, light_, receivers_.points[pixel]);
    int traced = 0;
    for (int points = least; points <= most; points *= 2) {
      for (int s = 0; s < kScrambles; ++s) add_scramble(queue, pixel, s, traced, points);
      traced = points;
      if (conclude(pixel, queue.finish(), points) <= settings_.standard_error) break;
    }
  }

  void add_scramble(RayQueue& queue, std::size_t pixel, int scramble, int begin, int end) const {
    const std::uint32_t key = filters::hash_bits(static_cast<std::uint32_t>(pixel) + filters::hash_bits(settings_.seed));
    const std::uint32_t own = filters::hash_bits(key + static_cast<std::uint32_t>(scramble));
    const glm::uvec2 shift(own, filters::hash_bits(own ^ 0x5bd1e995u));
    const std::size_t first = static_cast<std::size_t>(scramble) * static_cast<std::size_t>(settings_.max_points);
    for (int i = begin; i < end; ++i) {
      const glm::uvec2 bits = points_[first + static_cast<std::size_t>(i)] ^ shift;
      queue.add(light_.direction(queue.origin(), to_unit_square(bits)), scramble);
    }
  }

  /// Notes mean and standard error over the scrambles; gives the latter.
  double conclude(std::size_t pixel, const std::array<int, kScrambles>& lit, int points) {
    double mean = 0.0, squares = 0.0;
    for (const int count : lit) mean += static_cast<double>(count) / points / kScrambles;
    for (const int count : lit) {
      const double deviation = static_cast<double>(count) / points - mean;
      squares += deviation * deviation;
    }
    // Stratified scrambles often agree to the point although none is exact: one point of deviation is presumed on top.
    const double presumed = 1.0 / points;
    const double error = std::sqrt((squares + presumed * presumed) / (kScrambles - 1) / kScrambles);
    truth_.visibility[pixel] = static_cast<float>(mean);
    truth_.rays[pixel] = static_cast<std::uint32_t>(kScrambles * points);
    const int total = std::accumulate(lit.begin(), lit.end(), 0);
    const bool unanimous = total == 0 || total == kScrambles * points;
    truth_.unanimous[pixel] = unanimous ? 1 : 0;
    truth_.standard_error[pixel] = unanimous ? 0.0f : static_cast<float>(error);
    return error;
  }
};

}  // namespace

AreaTruth trace_area(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light,
                     const AreaSettings& settings) {
  assert(std::has_single_bit(static_cast<unsigned>(settings.max_points)) && settings.max_points >= kEdgePoints);
  return AreaTracer(occluders, receivers, light, settings).run();
}

std::vector<float> trace_hard(const Occluders& occluders, const ReceiverImage& receivers, const AreaLight& light) {
  std::vector<float> visibility(receivers.points.size(), 1.0f);
  tbb::parallel_for(0, receivers.height, [&](int y) {
    for (int x = 0; x < receivers.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(receivers.width) + static_cast<std::size_t>(x);
      if (!receivers.points[i].counts) continue;
      RayQueue queue(occluders, light, receivers.points[i]);
      queue.add(light.centre_direction(queue.origin()), 0);
      visibility[i] = static_cast<float>(queue.finish()[0]);
    }
  });
  return visibility;
}

}  // namespace shadowbench::reference
