#include "harness/run/run_progress.h"

#include <chrono>
#include <numeric>

namespace shadowbench::run {
namespace {

using options::Work;

/// Each image that a step traces takes it so much of the rest of its way.
constexpr double kShareOfTrace = 0.8;
/// What a picture of any size costs, in pixels.
constexpr double kFixedMegapixels = 0.05;

/// The seconds that a step takes for one cell, roughly, on two cores: only their ratios count, and only until the first
/// step of a kind is done. Those of pictures grow with their pixels, those of adaptive timing with its budget.
double presume_cost(const options::RunOptions& options, Work kind) {
  const double megapixels = kFixedMegapixels + 1e-6 * options.width * options.height;
  const double frames = 1.0 + std::accumulate(options.lights.begin(), options.lights.end(), 0.0);
  switch (kind) {
    case Work::kDrawing:
      return megapixels * (0.2 + (options.stability ? 1.0 : 0.0) + (options.uncertainty ? 2.0 : 0.0));
    case Work::kTiming:
      return options.rounds.is_fixed()
                 ? 0.03 * megapixels * options.rounds.most * frames
                 : 1e-3 * options.rounds.budget_ms * (1.0 + static_cast<double>(options.lights.size()));
    case Work::kPhases: return 0.05 * megapixels * (options.phases - 1);
    case Work::kTruth:
    case Work::kScores: return options.truth ? 0.2 * megapixels : 0.0;
    case Work::kSurroundings: return options.truth ? 0.15 * megapixels : 0.0;
    case Work::kAttribution: return options.truth && options.attribution ? 0.9 * megapixels : 0.0;
    case Work::kFrames: return options.frames > 1 ? megapixels * (4.0 + 0.2 * options.frames) : 0.0;
    case Work::kPictures: return 0.6 * megapixels;
    case Work::kReport: return 0.02;
  }
  return 0.0;
}

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

RunProgress::RunProgress(options::Progress& shown) : shown_(shown), meter_(now_s) {}

void RunProgress::plan(const RunPlan& plan) {
  for (const PlannedTask& task : plan.tasks) {
    const double cells = static_cast<double>(task.task.filters.size());
    const options::RunOptions& options = plan.scenes[task.scene].options;
    report_cost_ += cells * presume_cost(options, Work::kReport);
    for (std::size_t kind = 0; kind < options::kWorks; ++kind)
      meter_.plan(static_cast<Work>(kind), cells * presume_cost(options, static_cast<Work>(kind)));
  }
  done_ = plan.finished;
  shown_.begin(plan.own_cells, plan.finished);
}

void RunProgress::begin(const options::RunOptions& options, Work kind, std::size_t cells, const std::string& what) {
  const double cost = static_cast<double>(cells) * presume_cost(options, kind);
  if (cost > 0.0) begin_step(kind, cost, what);
}

void RunProgress::begin_report() { begin_step(Work::kReport, report_cost_, "writing the report"); }

void RunProgress::begin_step(Work kind, double cost, const std::string& what) {
  const std::scoped_lock lock(mutex_);
  meter_.begin(kind, cost);
  what_ = what;
  traced_ = 0.0;
  last_share_ = -1.0;
  show();
}

void RunProgress::advance(double part) {
  const std::scoped_lock lock(mutex_);
  meter_.advance(part);
  show();
}

void RunProgress::advance_tracing(double part) {
  const std::scoped_lock lock(mutex_);
  if (part >= 1.0) {
    traced_ += (1.0 - traced_) * kShareOfTrace;
    meter_.advance(traced_);
  } else {
    meter_.advance(traced_ + (1.0 - traced_) * kShareOfTrace * part);
  }
  show();
}

void RunProgress::count(int cells) {
  const std::scoped_lock lock(mutex_);
  done_ += cells;
}

void RunProgress::finish() {
  const std::scoped_lock lock(mutex_);
  meter_.finish();
  what_ = "done";
  last_share_ = -1.0;
  show();
}

void RunProgress::show() {
  const options::WorkAhead ahead = meter_.ahead();
  if (ahead.share - last_share_ < 1e-3) return;
  last_share_ = ahead.share;
  shown_.show(done_, what_, ahead);
}

}  // namespace shadowbench::run
