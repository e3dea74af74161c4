#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "harness/gl/timer.h"
#include "harness/render/filter_passes.h"

namespace shadowbench::run {

/// Times of one filter, one entry per round; milliseconds.
struct FilterTimes {
  std::vector<double> prefilter;  ///< empty for filters that read depth
  std::vector<double> lookup;
};

/// Times of a set of filters that took turns; entry i of every list comes from round i.
struct RoundTimes {
  std::vector<double> map;
  std::vector<FilterTimes> filters;  ///< in the order given
};

/// Says how to time.
struct TimingOptions {
  gl::TimerKind timer = gl::TimerKind::kWallClock;
  int rounds = 11;
  std::uint64_t seed = 0;  ///< of the order in which filters take turns
};

/// Times the shadow map, prefilters and lookups in interleaved rounds: every round runs each filter once, in a shuffled
/// order, so that drift of the machine's speed hits all of them alike. Two rounds warm up and are not counted.
/// Cost: (rounds + 2) times the sum of all passes.
RoundTimes time_rounds(const std::vector<render::FilterPasses*>& filters, const std::function<void()>& draw_map,
                       const render::ShadowMap& map, const render::GBuffer& gbuffer, const TimingOptions& options);

}  // namespace shadowbench::run
