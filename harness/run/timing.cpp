#include "harness/run/timing.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace shadowbench::run {
namespace {

constexpr int kWarmUpRounds = 2;

/// Fisher and Yates; std::shuffle differs between standard libraries.
void shuffle(std::vector<std::size_t>& order, std::mt19937_64& generator) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[generator() % i]);
}

}  // namespace

RoundTimes time_rounds(const std::vector<render::FilterPasses*>& filters, const std::function<void()>& draw_map,
                       const render::ShadowMap& map, const render::GBuffer& gbuffer, const TimingOptions& options) {
  RoundTimes times;
  times.filters.resize(filters.size());
  render::ImageTarget target("timed visibility", GL_R32F, gbuffer.width(), gbuffer.height());
  std::mt19937_64 generator(options.seed);
  std::vector<std::size_t> order(filters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int round = -kWarmUpRounds; round < options.rounds; ++round) {
    const bool counted = round >= 0;
    const double map_ms = gl::time_ms(options.timer, draw_map);
    if (counted) times.map.push_back(map_ms);
    shuffle(order, generator);
    for (const std::size_t i : order) {
      render::FilterPasses& filter = *filters[i];
      const double prefilter_ms =
          filter.has_prefilter() ? gl::time_ms(options.timer, [&] { filter.prefilter(map); }) : 0.0;
      const double lookup_ms = gl::time_ms(options.timer, [&] { filter.lookup(gbuffer, map, target); });
      if (!counted) continue;
      if (filter.has_prefilter()) times.filters[i].prefilter.push_back(prefilter_ms);
      times.filters[i].lookup.push_back(lookup_ms);
    }
  }
  return times;
}

}  // namespace shadowbench::run
