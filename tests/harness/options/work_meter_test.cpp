#include "harness/options/work_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace shadowbench::options {
namespace {

/// A step, with what it really takes.
struct Step {
  Work kind;
  double cost;
  double seconds;
};

/// Three tasks of the same steps, whose presumed costs are far from what they take.
std::vector<Step> make_steps() {
  std::vector<Step> steps;
  for (int task = 0; task < 3; ++task) {
    steps.insert(steps.end(), {{Work::kDrawing, 1.0, 0.1}, {Work::kTiming, 2.0, 3.0}, {Work::kTruth, 0.5, 8.0}});
    for (int cell = 0; cell < 4; ++cell) steps.push_back({Work::kAttribution, 1.0, 0.5});
    steps.push_back({Work::kPictures, 3.0, 1.0});
  }
  return steps;
}

/// A clock that moves with the steps alone.
struct Bench {
  double now = 100.0;
  WorkMeter meter{[this] { return now; }};

  explicit Bench(const std::vector<Step>& steps) {
    for (const Step& step : steps) meter.plan(step.kind, step.cost);
  }

  /// Carries a step out in so many parts, and says where it is after each.
  std::vector<double> carry_out(const Step& step, int parts) {
    std::vector<double> shares;
    meter.begin(step.kind, step.cost);
    for (int part = 1; part <= parts; ++part) {
      now += step.seconds / parts;
      meter.advance(static_cast<double>(part) / parts);
      shares.push_back(meter.ahead().share);
    }
    return shares;
  }
};

TEST(WorkMeter, EveryPieceOfWorkMovesTheShare_WhichEndsAtOne) {
  const std::vector<Step> steps = make_steps();
  for (const int parts : {1, 7}) {
    Bench bench(steps);
    EXPECT_EQ(bench.meter.ahead().share, 0.0);
    EXPECT_FALSE(bench.meter.ahead().seconds_left);
    double before = 0.0;
    for (const Step& step : steps) {
      for (const double share : bench.carry_out(step, parts)) {
        EXPECT_GT(share, before);
        EXPECT_LE(share, 1.0 + 1e-12);
        before = share;
      }
    }
    EXPECT_NEAR(before, 1.0, 1e-12);
    EXPECT_NEAR(*bench.meter.ahead().seconds_left, 0.0, 1e-12);
    bench.meter.finish();
    EXPECT_EQ(bench.meter.ahead().share, 1.0);
  }
}

TEST(WorkMeter, OnceEveryKindWasDone_TimeLeftIsWhatTheRestTakes_AndStepsAreOfEqualCost) {
  const std::vector<Step> steps = make_steps();
  Bench bench(steps);
  const std::size_t first = steps.size() / 3;
  for (std::size_t i = 0; i < first; ++i) bench.carry_out(steps[i], 1);
  double left = 0.0;
  for (std::size_t i = first; i < steps.size(); ++i) left += steps[i].seconds;
  const double seconds = left, share = bench.meter.ahead().share;
  for (std::size_t i = first; i < steps.size(); ++i) {
    EXPECT_NEAR(*bench.meter.ahead().seconds_left, left, 1e-9);
    EXPECT_NEAR(bench.meter.ahead().share, share + (1.0 - share) * (1.0 - left / seconds), 1e-9);
    bench.carry_out(steps[i], 2);
    left -= steps[i].seconds;
  }
}

TEST(WorkMeter, PlansThatAreWrong_NeverTakeTheShareBack) {
  Bench bench(make_steps());
  double before = 0.0;
  for (int i = 0; i < 20; ++i) {  // more and dearer steps than were planned, and parts that fall back
    for (const double share : bench.carry_out({i % 2 ? Work::kTruth : Work::kPictures, 2.0, 1.0 + i}, 3)) {
      EXPECT_GE(share, before);
      before = share;
    }
    bench.meter.advance(0.1);
    EXPECT_EQ(bench.meter.ahead().share, before);
  }
  EXPECT_LT(before, 1.0);
  bench.meter.finish();
  EXPECT_EQ(bench.meter.ahead().share, 1.0);
}

}  // namespace
}  // namespace shadowbench::options
