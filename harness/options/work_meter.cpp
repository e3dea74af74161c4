#include "harness/options/work_meter.h"

#include <algorithm>

namespace shadowbench::options {

namespace {

/// The very first pieces, which compile and load, tell little of the others.
constexpr double kLeastShare = 0.02;

}  // namespace

WorkMeter::WorkMeter(std::function<double()> clock) : clock_(std::move(clock)), last_s_(clock_()) {}

void WorkMeter::plan(Work kind, double cost) { kinds_[static_cast<std::size_t>(kind)].left += cost; }

void WorkMeter::begin(Work kind, double cost) {
  advance(1.0);
  current_ = static_cast<std::size_t>(kind);
  cost_ = cost;
  part_ = 0.0;
}

void WorkMeter::advance(double part) {
  part = std::min(part, 1.0);
  if (part <= part_) return;
  Kind& kind = kinds_[current_];
  const double cost = std::min((part - part_) * cost_, kind.left), now = clock_();
  kind.seconds += now - last_s_;
  last_s_ = now;
  part_ = part;
  kind.done += cost;
  if (const double before = seconds_left(); before > 0.0)
    share_ += (1.0 - share_) * std::min(cost * rate(kind) / before, 1.0);
  kind.left -= cost;
}

void WorkMeter::finish() {
  for (Kind& kind : kinds_) kind.left = 0.0;
  share_ = 1.0;
}

/// Seconds for each unit of presumed cost: of this kind where some of it is done, of all that is done where not.
double WorkMeter::rate(const Kind& kind) const {
  if (kind.done > 0.0) return kind.seconds / kind.done;
  Kind all;
  for (const Kind& each : kinds_) {
    all.done += each.done;
    all.seconds += each.seconds;
  }
  return all.done > 0.0 && all.seconds > 0.0 ? all.seconds / all.done : 1.0;
}

double WorkMeter::seconds_left() const {
  double seconds = 0.0;
  for (const Kind& kind : kinds_) seconds += kind.left * rate(kind);
  return seconds;
}

WorkAhead WorkMeter::ahead() const {
  return {share_, share_ < kLeastShare ? std::nullopt : std::optional(seconds_left())};
}

}  // namespace shadowbench::options
