#include "harness/view/time_meter.h"

#include <algorithm>

#include "harness/gl/timer/timer.h"
#include "harness/measure/timing/statistics.h"
#include "harness/measure/timing/timing.h"

namespace shadowbench::view {
namespace {

constexpr std::size_t kRoundsOfADrawing = 40;

}  // namespace

void TimeHistory::add(double ms) {
  if (ms_.size() == kMost) ms_.erase(ms_.begin());
  ms_.push_back(static_cast<float>(ms));
}

std::optional<double> TimeHistory::median() const {
  if (ms_.empty()) return std::nullopt;
  return measure::summarise({ms_.begin(), ms_.end()}).median;
}

bool TimeMeter::step() {
  if (drawing_ != bench_.drawings()) {
    drawing_ = bench_.drawings();
    rounds_ = 0;
    round_.clear();
    map_.clear();
    sides_ = {};
  }
  if (bench_.is_busy() || rounds_ == kRoundsOfADrawing) return false;
  if (round_.empty()) plan_round();
  const std::function<void()> pass = std::move(round_.back());
  round_.pop_back();
  pass();
  if (round_.empty()) ++rounds_;
  return rounds_ < kRoundsOfADrawing;
}

void TimeMeter::plan_round() {
  round_.emplace_back([this] { map_.add(time([this] { bench_.stage().redraw_map(bench_.state()); })); });
  for (std::size_t side = 0; side < kSides; ++side)
    if (bench_.stage().passes(side) != nullptr) plan_side(side, round_);
  std::reverse(round_.begin(), round_.end());
}

void TimeMeter::plan_side(std::size_t side, std::vector<std::function<void()>>& round) {
  Stage& stage = bench_.stage();
  Side& times = sides_[side];
  if (stage.passes(side)->has_prefilter()) {
    round.emplace_back(
        [&, side] { times.prefilter.add(time([&] { stage.passes(side)->prefilter(stage.light_map().map); })); });
    for (int i = 0; i < measure::kSettlingLookups; ++i)
      round.emplace_back([&, side] { time([&] { stage.look_up(side); }); });
  }
  round.emplace_back([&, side] { times.lookup.add(lookup_ms_ = time([&] { stage.look_up(side); })); });
  round.emplace_back([&, side] { times.filter.add(lookup_ms_ - time([&] { stage.look_up_nothing(side); })); });
}

double TimeMeter::time(const std::function<void()>& work) const { return gl::time_ms(bench_.renderer().timer, work); }

}  // namespace shadowbench::view
