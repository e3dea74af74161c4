// What a run is presumed to take: ratios that must hold on any machine.

#include "harness/run/time_forecast.h"

#include <gtest/gtest.h>

namespace shadowbench::run {
namespace {

/// One scene with one task.
struct Plan : RunPlan {
  explicit Plan(std::size_t filters = 8) {
    scenes.resize(1);
    scenes.front().options.frames = 4;
    scenes.front().options.gpus.resize(1);
    tasks.resize(1);
    tasks.front().task.filters.resize(filters);
  }

  options::RunOptions& options() { return scenes.front().options; }
  double task_s() const { return presume_task_s(scenes.front(), tasks.front()); }
  double timing_s() const { return presume_timing_s(scenes.front(), tasks.front()); }
  double all_s() const { return forecast_time(*this).seconds; }
};

TEST(TimeForecast, TruthOfAView_IsTracedOnce_HoweverManyFiltersThereAre) {
  EXPECT_NEAR(Plan(9).task_s() - Plan(6).task_s(), Plan(6).task_s() - Plan(3).task_s(), 1e-9);
  EXPECT_GT(2.0 * Plan(3).task_s(), Plan(6).task_s());
  EXPECT_NEAR(2.0 * Plan(3).timing_s(), Plan(6).timing_s(), 1e-9);
  EXPECT_EQ(Plan(0).task_s() + Plan(0).timing_s(), 0.0);
}

TEST(TimeForecast, GrowsWithPictureAndMap_AndNotFaster) {
  const Plan small;
  Plan large, deep;
  large.options().width *= 2;
  large.options().height *= 2;
  deep.tasks.front().task.map_size *= 2;
  for (const Plan& grown : {large, deep}) {
    EXPECT_GT(grown.all_s(), small.all_s());
    EXPECT_LE(grown.task_s(), 4.0 * small.task_s());
    EXPECT_LE(grown.timing_s(), 4.0 * small.timing_s());
  }
}

TEST(TimeForecast, LeavesOut_WhatTheCacheHas_AndWhatIsNotAskedFor) {
  const Plan cold;
  Plan warm, all[6];
  warm.tasks.front().is_traced = true;
  EXPECT_LT(warm.task_s(), cold.task_s());
  all[0].options().truth = all[1].options().attribution = all[2].options().pictures = false;
  all[3].options().gpus.clear();
  all[4].options().frames = all[5].options().phases = 1;
  for (const Plan& quick : all) EXPECT_LT(quick.all_s(), cold.all_s()) << &quick - all;
}

}  // namespace
}  // namespace shadowbench::run
