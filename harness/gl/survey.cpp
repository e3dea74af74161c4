#include "harness/gl/survey.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <vector>

#include "harness/gl/objects.h"

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

namespace {

// Fractions are sampled in two goes: all of [0, 1) in steps of 2^-12, and where that shows no steps, the 4096 finest
// steps that an fp32 coordinate above 0.5 can make.
constexpr int kCoarseBits = 12, kFinestBits = 23;
constexpr int kSteps = 1 << kCoarseBits;

/// The bits follow from the mean distance between the values that occur.
int count_bits(std::vector<float> weights) {
  std::ranges::sort(weights);
  const double range = static_cast<double>(weights.back()) - static_cast<double>(weights.front());
  weights.erase(std::unique(weights.begin(), weights.end()), weights.end());
  if (weights.size() < 2) return 0;
  return static_cast<int>(std::lround(-std::log2(range / static_cast<double>(weights.size() - 1))));
}

/// The fractional bits of the weights between two texels of a colour format: 8 means steps of 1/256.
int measure_weight_bits(GLenum format) {
  Texture map("survey step", format, 2, 1);
  map.set_filter(GL_LINEAR, GL_LINEAR);
  map.upload_floats(map.format().channels == 1 ? std::vector{0.0f, 1.0f} : std::vector{0.0f, 0.0f, 1.0f, 1.0f},
                    map.format().channels);
  SurveyShader shader("survey_filter.frag", {kSteps, 1});
  const auto count = [&](float first, int bits) {
    map.bind(0);
    shader.program().set("u_map", 0);
    shader.program().set("u_first", first);
    shader.program().set("u_step", std::exp2(-static_cast<float>(bits)));
    return count_bits(shader.run());
  };
  const int coarse = count(0.0f, kCoarseBits);
  return coarse < kCoarseBits ? coarse : std::clamp(count(0.5f, kFinestBits), kCoarseBits, kFinestBits);
}

/// The worst relative error of exp() over [-80, 80], in units of 2^-24.
double measure_exp_roundoffs() {
  constexpr int kSide = 256;
  constexpr double kLimit = 80.0;
  std::vector<float> arguments(kSide * kSide);
  for (std::size_t i = 0; i < arguments.size(); ++i)
    arguments[i] =
        static_cast<float>(kLimit * (2.0 * static_cast<double>(i) / static_cast<double>(arguments.size() - 1) - 1.0));
  Texture texture("survey arguments", GL_R32F, kSide, kSide);
  texture.upload_floats(arguments, 1);
  SurveyShader shader("survey_exp.frag", {kSide, kSide});
  texture.bind(0);
  shader.program().set("u_arguments", 0);
  const std::vector<float> values = shader.run();
  double worst = 0.0;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    worst =
        std::max(worst, std::abs(static_cast<double>(values[i]) / std::exp(static_cast<double>(arguments[i])) - 1.0));
  return worst * 0x1p24;
}

}  // namespace

filters::GlAccuracy survey_gl() {
  return {.exp_roundoffs = measure_exp_roundoffs(),
          .weight_bits = static_cast<double>(std::min(measure_weight_bits(GL_R32F), measure_weight_bits(GL_RG32F)))};
}

int measure_loop_turns() {
  constexpr int kTurns = 1 << 20;
  SurveyShader shader("survey_loop.frag", {1, 1});
  shader.program().set("u_turns", kTurns);
  const int turns = static_cast<int>(shader.run().front());
  return turns < kTurns ? turns : 0;
}

SurveyShader::SurveyShader(const std::string& fragment, glm::ivec2 size, GLenum format)
    : program_(fragment, FullscreenTriangle::vertex_source(), embedded_source(fragment)),
      target_(fragment, format, size.x, size.y),
      framebuffer_(fragment) {
  framebuffer_.attach_color(0, target_);
}

void SurveyShader::draw() {
  framebuffer_.bind();
  program_.use();
  triangle_.draw();
}

std::vector<float> SurveyShader::run() {
  draw();
  return target_.read_floats(target_.format().channels);
}

}  // namespace shadowbench::gl
