#include "harness/run/run_progress.h"

#include <algorithm>
#include <chrono>

#include "harness/run/time_forecast.h"

namespace shadowbench::run {
namespace {

using options::Work;

/// Each image that a step traces takes it so much of the rest of its way.
constexpr double kShareOfTrace = 0.8;
/// Until all is done, whatever was presumed of it.
constexpr double kMostShare = 0.999;
double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

RunProgress::RunProgress(options::Progress& shown) : shown_(shown), meter_(now_s) {}

void RunProgress::plan(const RunPlan& plan) {
  for (const PlannedTask& task : plan.tasks)
    for (std::size_t kind = 0; kind < options::kWorks; ++kind)
      meter_.plan(static_cast<Work>(kind), static_cast<double>(task.task.filters.size()) *
                                               presume_cell_s(plan.scenes[task.scene], task, static_cast<Work>(kind)));
  report_cost_ = presume_report_s(plan);
  meter_.plan(Work::kReport, report_cost_);
  done_ = plan.finished;
  shown_.begin(plan.own_cells, plan.finished);
}

void RunProgress::begin(const PlannedScene& scene, const PlannedTask& task, Work kind, std::size_t cells,
                        const std::string& what) {
  const double cost = static_cast<double>(cells) * presume_cell_s(scene, task, kind);
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
  finished_ = true;
  what_ = "done";
  last_share_ = -1.0;
  show();
}

void RunProgress::show() {
  options::WorkAhead ahead = meter_.ahead();
  if (!finished_) ahead.share = std::min(ahead.share, kMostShare);
  if (ahead.share - last_share_ < 1e-3) return;
  last_share_ = ahead.share;
  shown_.show(done_, what_, ahead);
}

}  // namespace shadowbench::run
