#include "harness/gl/timer/timer.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <vector>

#include "harness/gl/objects.h"
#include "harness/gl/survey/survey.h"

namespace shadowbench::gl {
namespace {

// Shorter work is mostly waiting for the GL to start, longer work tells nothing more.
constexpr double kShortestMs = 1.0;
constexpr double kLongestMs = 8.0;
constexpr int kMostIterations = 1 << 20;
constexpr int kRepeats = 5;

/// One run of some work, by both clocks.
struct Run {
  double wall_ms = 0.0;
  double query_ms = 0.0;

  bool agrees() const {
    constexpr double kLeastRatio = 0.5;
    constexpr double kMostRatio = 1.05;
    return query_ms >= kLeastRatio * wall_ms && query_ms <= kMostRatio * wall_ms;
  }
};

double time_by_wall_clock(const std::function<void()>& work) {
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  work();
  glFinish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double get_ms(const Query& query) {
  constexpr double kMsPerNs = 1e-6;
  return static_cast<double>(query.result()) * kMsPerNs;
}

Run time_by_both(const std::function<void()>& work) {
  Query query("timer check", GL_TIME_ELAPSED);
  Run run;
  run.wall_ms = time_by_wall_clock([&] {
    query.begin();
    work();
    query.end();
  });
  run.query_ms = get_ms(query);
  return run;
}

// Doubles the work until it is long enough; `work` takes the number of iterations.
std::vector<Run> collect_runs(const std::function<void(int)>& work) {
  work(1);  // the first draw also compiles
  std::vector<Run> runs;
  for (int iterations = 1; iterations <= kMostIterations; iterations *= 2) {
    const double wall_ms = time_by_wall_clock([&] { work(iterations); });
    if (wall_ms < kShortestMs) continue;
    for (int i = 0; i < kRepeats; ++i) runs.push_back(time_by_both([&] { work(iterations); }));
    if (wall_ms >= kLongestMs) break;
  }
  return runs;
}

}  // namespace

const char* timer_name(TimerKind kind) { return kind == TimerKind::kQuery ? "query" : "wall clock"; }

TimerKind TimerCheck::choice() const {
  constexpr double kEnough = 0.9;
  return agreement >= kEnough ? TimerKind::kQuery : TimerKind::kWallClock;
}

TimerCheck check_timer(Context&) {
  constexpr int kSide = 1024;  // many tiles, see TimerCheck::choice
  SurveyShader shader("survey_load.frag", {kSide, kSide});
  auto runs = collect_runs([&](int iterations) {
    shader.program().set("u_iterations", iterations);
    shader.draw();
  });
  if (runs.empty()) return {};  // too fast for the wall clock: nothing is known
  TimerCheck check;
  const auto agreeing = static_cast<double>(std::ranges::count_if(runs, &Run::agrees));
  check.agreement = agreeing / static_cast<double>(runs.size());
  const auto longest = std::span(runs).last(kRepeats);
  std::ranges::sort(longest, {}, &Run::wall_ms);
  check.wall_ms = longest[kRepeats / 2].wall_ms;
  std::ranges::sort(longest, {}, &Run::query_ms);
  check.query_ms = longest[kRepeats / 2].query_ms;
  return check;
}

TimerKind choose_timer(Context& context) {
  if (context.info().software) return TimerKind::kWallClock;
  return check_timer(context).choice();
}

double time_ms(TimerKind kind, const std::function<void()>& work) {
  if (kind == TimerKind::kWallClock) return time_by_wall_clock(work);
  glFinish();
  Query query("timer", GL_TIME_ELAPSED);
  query.begin();
  work();
  query.end();
  return get_ms(query);
}

}  // namespace shadowbench::gl
