// What a run is presumed to take: ratios that must hold on any machine.

#include "harness/run/time_forecast.h"

#include <gtest/gtest.h>

namespace shadowbench::run {
namespace {

using options::Work;

/// One scene with one task.
struct Plan : RunPlan {
  explicit Plan(std::size_t filters = 8) {
    scenes.resize(1);
    scenes.front().options.frames = 4;
    scenes.front().options.gpus.resize(1);
    tasks.resize(1);
    tasks.front().task.filters.resize(filters);
  }

  double task_s(Work kind) const {
    return static_cast<double>(tasks.front().task.filters.size()) * presume_cell_s(scenes.front(), tasks.front(), kind);
  }

  double all_s() const {
    double seconds = presume_report_s(*this);
    for (std::size_t kind = 0; kind < options::kWorks; ++kind) seconds += task_s(static_cast<Work>(kind));
    return seconds;
  }
};

TEST(TimeForecast, TruthOfAView_IsTracedOnce_HoweverManyFiltersThereAre) {
  for (const Work kind : {Work::kTruth, Work::kSurroundings})
    EXPECT_NEAR(Plan(3).task_s(kind), Plan(30).task_s(kind), 1e-9);
  for (const Work kind : {Work::kDrawing, Work::kTiming, Work::kAttribution, Work::kGpus, Work::kPictures})
    EXPECT_NEAR(10.0 * Plan(3).task_s(kind), Plan(30).task_s(kind), 1e-9);
}

TEST(TimeForecast, GrowsWithPictureAndMap_AndNotFaster) {
  const Plan small;
  Plan large, deep;
  large.scenes.front().options.width *= 2;
  large.scenes.front().options.height *= 2;
  deep.tasks.front().task.map_size *= 2;
  for (const Plan& grown : {large, deep}) {
    EXPECT_GT(grown.all_s(), small.all_s());
    for (std::size_t kind = 0; kind < options::kWorks; ++kind)
      EXPECT_LE(grown.task_s(static_cast<Work>(kind)), 4.0 * small.task_s(static_cast<Work>(kind))) << kind;
  }
}

TEST(TimeForecast, LeavesOut_WhatTheCacheHas_AndWhatIsNotAskedFor) {
  const Plan cold;
  Plan warm, quick;
  warm.tasks.front().is_traced = true;
  for (const Work kind : {Work::kTruth, Work::kSurroundings, Work::kAttribution}) {
    EXPECT_LT(warm.task_s(kind), cold.task_s(kind));
    EXPECT_GT(warm.task_s(kind), 0.0);
  }
  options::RunOptions& options = quick.scenes.front().options;
  options.truth = false;
  options.gpus.clear();
  options.frames = options.phases = 1;
  for (const Work kind : {Work::kTruth, Work::kScores, Work::kSurroundings, Work::kAttribution, Work::kGpus,
                          Work::kFrames, Work::kPhases})
    EXPECT_EQ(quick.task_s(kind), 0.0);
  EXPECT_LT(quick.all_s(), warm.all_s());
}

}  // namespace
}  // namespace shadowbench::run
