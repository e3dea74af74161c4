#include "reference/truth/adaptive_tracer.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

#include "filters/random.h"

namespace shadowbench::reference {
namespace {

constexpr int kFirstPoints = 4;
static_assert(kFirstPoints * kScrambles == kRaysOfSettledPixel);
/// An edge is not judged by fewer points per scramble: small counts make small standard errors by chance.
constexpr int kEdgePoints = 16;

using Counts = std::array<int, kScrambles>;

/// One point of all scrambles as a packet. Rays below the receiver's own plane stay inactive.
RayPacket make_packet(const RayFan& fan, const SampleSets::Lanes& lanes) {
  RayPacket packet;
  packet.reach = fan.reach;
  for (int axis = 0; axis < 3; ++axis) {
    RayPacket::Lanes& origin = packet.origin[static_cast<std::size_t>(axis)];
    RayPacket::Lanes& direction = packet.direction[static_cast<std::size_t>(axis)];
    for (std::size_t i = 0; i < lanes.x.size(); ++i) {
      origin[i] = fan.origin[axis] + lanes.x[i] * fan.origin_x[axis] + lanes.y[i] * fan.origin_y[axis];
      direction[i] = fan.direction[axis] + lanes.x[i] * fan.direction_x[axis] + lanes.y[i] * fan.direction_y[axis];
    }
  }
  const auto& d = packet.direction;
  for (std::size_t i = 0; i < lanes.x.size(); ++i) {
    const float above = d[0][i] * fan.normal.x + d[1][i] * fan.normal.y + d[2][i] * fan.normal.z;
    packet.active |= (above > 0.0f ? 1u : 0u) << i;
  }
  return packet;
}

class AdaptiveTracer {
 public:
  AdaptiveTracer(const Occluders& occluders, const ReceiverImage& receivers, const SampleSets& samples,
                 const TraceSettings& settings, const std::function<RayFan(const ReceiverPoint&)>& make_fan)
      : occluders_(occluders), receivers_(receivers), samples_(samples), settings_(settings), make_fan_(make_fan) {}

  TracedVisibility run() {
    const std::size_t pixels = receivers_.points.size();
    truth_.visibility.assign(pixels, 1.0f);
    truth_.standard_error.assign(pixels, 0.0f);
    truth_.unanimous.assign(pixels, 1);
    truth_.rays.assign(pixels, 0);
    for_each_receiver([this](std::size_t i) { trace(i, kFirstPoints, kFirstPoints); });
    const std::vector<float> first = truth_.visibility;
    for_each_receiver([&](std::size_t i) {
      if (!is_settled(first, static_cast<int>(i))) trace(i, kEdgePoints, samples_.max_points());
    });
    return std::move(truth_);
  }

 private:
  const Occluders& occluders_;
  const ReceiverImage& receivers_;
  const SampleSets& samples_;
  const TraceSettings& settings_;
  const std::function<RayFan(const ReceiverPoint&)>& make_fan_;
  TracedVisibility truth_;

  /// In tiles: rays of neighbouring pixels visit the same parts of the scene.
  template <class Work>
  void for_each_receiver(Work work) {
    const tbb::blocked_range2d<int> all(0, receivers_.height, 16, 0, receivers_.width, 16);
    tbb::parallel_for(all, [&](const tbb::blocked_range2d<int>& tile) {
      for (int y = tile.rows().begin(); y < tile.rows().end(); ++y) {
        for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) {
          const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(receivers_.width) + static_cast<std::size_t>(x);
          if (receivers_.points[i].counts) work(i);
        }
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
    const RayFan fan = make_fan_(receivers_.points[pixel]);
    const std::uint32_t key = static_cast<std::uint32_t>(pixel) + filters::hash_bits(settings_.seed);
    const int set = static_cast<int>(filters::hash_bits(key) % SampleSets::kSets);
    Counts lit{};
    int traced = 0;
    for (int points = least; points <= most; points *= 2) {
      for (; traced < points; ++traced) add(lit, make_packet(fan, samples_.at(set, traced)));
      if (conclude(pixel, lit, points) <= settings_.standard_error) break;
    }
  }

  void add(Counts& lit, const RayPacket& packet) const {
    if (settings_.on_packet) settings_.on_packet(packet);
    const std::uint32_t seen = packet.active & ~occluders_.find_blocked(packet);
    for (std::size_t s = 0; s < lit.size(); ++s) lit[s] += static_cast<int>(seen >> s & 1u);
  }

  /// Notes mean and standard error over the scrambles; gives the latter.
  double conclude(std::size_t pixel, const Counts& lit, int points) {
    const int total = std::accumulate(lit.begin(), lit.end(), 0);
    const double mean = static_cast<double>(total) / points / kScrambles;
    double squares = 0.0;
    for (const int count : lit) {
      const double deviation = static_cast<double>(count) / points - mean;
      squares += deviation * deviation;
    }
    // Stratified scrambles often agree to the point although none is exact: one point of deviation is presumed on top.
    const double presumed = 1.0 / points;
    const double error = std::sqrt((squares + presumed * presumed) / (kScrambles - 1) / kScrambles);
    const bool unanimous = total == 0 || total == kScrambles * points;
    truth_.visibility[pixel] = static_cast<float>(mean);
    truth_.rays[pixel] = static_cast<std::uint32_t>(kScrambles * points);
    truth_.unanimous[pixel] = unanimous ? 1 : 0;
    truth_.standard_error[pixel] = unanimous ? 0.0f : static_cast<float>(error);
    return error;
  }
};

}  // namespace

TracedVisibility trace_fans(const Occluders& occluders, const ReceiverImage& receivers, const SampleSets& samples,
                            const TraceSettings& settings,
                            const std::function<RayFan(const ReceiverPoint&)>& make_fan) {
  assert(std::has_single_bit(static_cast<unsigned>(samples.max_points())) && samples.max_points() >= kEdgePoints);
  return AdaptiveTracer(occluders, receivers, samples, settings, make_fan).run();
}

}  // namespace shadowbench::reference
