#include "harness/gl/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
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

namespace {

// Fractions are sampled in two goes: all of [0, 1) in steps of 2^-12, and where that shows no steps, the 4096 finest
// steps that an fp32 coordinate above 0.5 can make.
constexpr int kCoarseBits = 12;
constexpr int kSamples = 1 << kCoarseBits;

struct Window {
  float first = 0.0f;
  float step = 0.0f;
};

constexpr Window kCoarse = {0.0f, 1.0f / static_cast<float>(kSamples)};
constexpr Window kFine = {0.5f, 1.0f / static_cast<float>(1 << WeightPrecision::kMaxBits)};

Texture make_step_map(GLenum format) {
  Texture map("survey step", format, 2, 1);
  map.set_filter(GL_LINEAR, GL_LINEAR);
  if (map.format().channels == 1)
    map.upload_floats(std::array{0.0f, 1.0f}, 1);
  else
    map.upload_floats(std::array{0.0f, 0.0f, 1.0f, 1.0f}, 2);
  if (map.format().depth) map.set_compare(GL_LEQUAL);
  return map;
}

std::vector<float> sample(SurveyShader& shader, const Texture& map, const Window& window) {
  Sampler::unbind(0);
  map.bind(0);
  shader.program().set("u_map", 0);
  shader.program().set("u_first", window.first);
  shader.program().set("u_step", window.step);
  return shader.run();
}

int count_distinct(std::vector<float> values) {
  std::ranges::sort(values);
  return static_cast<int>(values.size() - std::ranges::unique(values).size());
}

double find_max_error(std::span<const float> weights, const Window& window) {
  double worst = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double exact = static_cast<double>(window.first) + static_cast<double>(i) * static_cast<double>(window.step);
    worst = std::max(worst, std::abs(static_cast<double>(weights[i]) - exact));
  }
  return worst;
}

// The bits follow from the mean distance between the values that occur.
int count_bits(const std::vector<float>& weights) {
  const auto [low, high] = std::ranges::minmax(weights);
  const int distinct = count_distinct(weights);
  if (distinct < 2) return 0;
  const double step = (static_cast<double>(high) - static_cast<double>(low)) / (distinct - 1);
  return static_cast<int>(std::lround(-std::log2(step)));
}

WeightPrecision measure_weights(SurveyShader& shader, const Texture& map) {
  const auto coarse = sample(shader, map, kCoarse);
  WeightPrecision precision;
  precision.bits = count_bits(coarse);
  precision.max_error = find_max_error(coarse, kCoarse);
  if (precision.bits < kCoarseBits) return precision;
  const auto fine = sample(shader, map, kFine);
  precision.bits = std::clamp(count_bits(fine), kCoarseBits, WeightPrecision::kMaxBits);
  precision.max_error = std::max(precision.max_error, find_max_error(fine, kFine));
  return precision;
}

/// Measures the weights of linear filtering of a colour format.
WeightPrecision measure_color_weights(GLenum format) {
  const Texture map = make_step_map(format);
  SurveyShader shader("survey_filter.frag", {kSamples, 1});
  return measure_weights(shader, map);
}

/// Counts the values that linear filtering yields between the texels 0 and 255 of R8.
int count_r8_levels() {
  const Texture map = make_step_map(GL_R8);
  SurveyShader shader("survey_filter.frag", {kSamples, 1});
  return count_distinct(sample(shader, map, kCoarse));
}

/// Whether a reference above 1 is compared as 1.
bool detect_clamped_reference(GLenum depth_format) {
  Texture map = make_step_map(depth_format);
  map.upload_floats(std::array{1.0f, 1.0f}, 1);
  SurveyShader shader("survey_compare.frag", {1, 1});
  shader.program().set("u_reference", 1.5f);
  return sample(shader, map, kCoarse).front() > 0.5f;
}

constexpr int kSide = 64;

struct Plane {
  float depth = 0.0f;
  glm::vec2 rise{0.0f};  ///< across the width and the height of the viewport
};

struct Offset {
  float factor = 0.0f;
  float units = 0.0f;
};

/// Draws planes into a depth texture and says what depth they get.
class PlaneDrawer {
 public:
  explicit PlaneDrawer(GLenum depth_format)
      : program_("survey plane", embedded_source("survey_plane.vert"), embedded_source("survey_plane.frag")),
        depth_("survey plane", depth_format, kSide, kSide),
        framebuffer_("survey plane"),
        empty_("survey plane") {
    framebuffer_.attach_depth(depth_);
  }

  /// Returns by how much `offset` moves the middle of the plane.
  double measure(const Plane& plane, const Offset& offset) { return draw(plane, offset) - draw(plane, {}); }

 private:
  double draw(const Plane& plane, const Offset& offset) {
    for (const GLenum capability : {GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE, GL_RASTERIZER_DISCARD})
      glDisable(capability);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(offset.factor, offset.units);
    framebuffer_.bind();
    program_.set("u_depth", plane.depth);
    program_.set("u_rise", plane.rise);
    program_.use();
    empty_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return static_cast<double>(depth_.read_floats(1)[kSide * (kSide / 2) + kSide / 2]);
  }

  Program program_;
  Texture depth_;
  Framebuffer framebuffer_;
  VertexArray empty_;
};

/// Returns by how much glPolygonOffset(factor 0, units 1) moves a surface of constant depth.
double measure_offset_unit(GLenum depth_format, float depth) {
  constexpr float kUnits = 4096.0f;  // many, so that the format's own steps do not show
  return PlaneDrawer(depth_format).measure({depth, {}}, {0.0f, kUnits}) / static_cast<double>(kUnits);
}

/// Returns the slope that glPolygonOffset's factor multiplies, as a multiple of the larger of two slopes 3:4.
double measure_slope_ratio() {
  constexpr float kFactor = 16.0f;
  constexpr glm::vec2 kRise = {0.09f, 0.12f};
  const double moved = PlaneDrawer(GL_DEPTH_COMPONENT32F).measure({0.1f, kRise}, {kFactor, 0.0f});
  return moved / static_cast<double>(kFactor * kRise.y / static_cast<float>(kSide));
}

constexpr int kArguments = 256;
constexpr int kMapSize = 1024;

// Columns are the borders between texels, rows the distances from them.
constexpr int kDistances = 128;

std::vector<float> list_arguments() {
  constexpr double kExpLimit = 80.0;
  std::vector<float> arguments;
  constexpr int kCount = kArguments * kArguments;
  for (int i = 0; i < kCount; ++i) {
    const double t = static_cast<double>(i) / (kCount - 1);
    arguments.push_back(static_cast<float>(kExpLimit * (2.0 * t - 1.0)));
    arguments.push_back(static_cast<float>(2.0 * std::numbers::pi * t));
  }
  return arguments;
}

// In texels: plus and minus 2^-14, which is one step of an fp32 coordinate near 1, up to 2^-6 in steps of 2^(1/8).
double get_distance(int row) {
  const double size = std::exp2(-14.0 + static_cast<double>(row / 2) / 8.0);
  return row % 2 == 0 ? size : -size;
}

std::vector<float> list_coordinates() {
  std::vector<float> coordinates;
  for (int row = 0; row < kDistances; ++row)
    for (int border = 0; border < kMapSize; ++border)
      coordinates.push_back(static_cast<float>((border + get_distance(row)) / kMapSize));
  return coordinates;
}

Texture make_index_map() {
  std::vector<float> indices(kMapSize);
  for (int i = 0; i < kMapSize; ++i) indices[static_cast<std::size_t>(i)] = static_cast<float>(i);
  Texture map("survey index", GL_R32F, kMapSize, 1);
  map.upload_floats(indices, 1);
  return map;
}

/// Fills exp_ulp, sin_error and cos_error.
void measure_functions(GlSurvey& measured) {
  const auto arguments = list_arguments();
  Texture texture("survey arguments", GL_RG32F, kArguments, kArguments);
  texture.upload_floats(arguments, 2);
  SurveyShader shader("survey_math.frag", {kArguments, kArguments}, GL_RGBA32F);
  Sampler::unbind(0);
  texture.bind(0);
  shader.program().set("u_arguments", 0);
  const auto values = shader.run();
  for (std::size_t i = 0; i < arguments.size() / 2; ++i) {
    const auto value = [&](std::size_t channel) { return static_cast<double>(values[4 * i + channel]); };
    const double exact = std::exp(static_cast<double>(arguments[2 * i]));
    const double angle = static_cast<double>(arguments[2 * i + 1]);
    measured.exp_ulp = std::max(measured.exp_ulp, std::abs(value(0) / exact - 1.0) * 0x1p24);
    measured.sin_error = std::max(measured.sin_error, std::abs(value(1) - std::sin(angle)));
    measured.cos_error = std::max(measured.cos_error, std::abs(value(2) - std::cos(angle)));
  }
}

/// Returns the farthest distance from a texel border, in texels of a 1024 map, at which the wrong texel is taken.
double measure_texel_border_error() {
  const auto coordinates = list_coordinates();
  Texture texture("survey coordinates", GL_R32F, kMapSize, kDistances);
  texture.upload_floats(coordinates, 1);
  const Texture map = make_index_map();
  SurveyShader shader("survey_nearest.frag", {kMapSize, kDistances});
  for (const GLuint unit : {0u, 1u}) Sampler::unbind(unit);
  map.bind(0);
  texture.bind(1);
  shader.program().set("u_map", 0);
  shader.program().set("u_coordinates", 1);
  const auto taken = shader.run();
  double worst = 0.0;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const double position = std::max(0.0, static_cast<double>(coordinates[i]) * kMapSize);
    if (static_cast<double>(taken[i]) == std::floor(position)) continue;
    worst = std::max(worst, std::abs(position - std::round(position)));
  }
  return worst;
}

DepthFormatSurvey measure_depth_format(Context& context, GLenum format) {
  constexpr float kNear = 0.25f;
  constexpr float kFar = 0.75f;
  DepthFormatSurvey measured;
  measured.pcf = measure_pcf_weights(context, format);
  measured.offset_unit_near = measure_offset_unit(format, kNear);
  measured.offset_unit_far = measure_offset_unit(format, kFar);
  measured.clamps_reference = detect_clamped_reference(format);
  return measured;
}

std::string format_weights(const WeightPrecision& weights) {
  const std::string bits = weights.exact() ? "exact fp32" : fmt::format("{} bits", weights.bits);
  return fmt::format("{} (worst error {:.2g})", bits, weights.max_error);
}

// Offset units are powers of two by the standard; whatever else comes is shown as it is.
std::string format_unit(double unit) {
  const double exponent = std::log2(unit);
  if (unit > 0.0 && std::abs(exponent - std::round(exponent)) < 0.01) return fmt::format("2^{:.0f}", exponent);
  return fmt::format("{:.4g}", unit);
}

std::string format_depth(std::string_view name, const DepthFormatSurvey& measured) {
  std::string text = fmt::format("  {:<5} PCF weights     {}\n", name, format_weights(measured.pcf));
  text += fmt::format("        polygon offset  {} at depth 0.25, {} at 0.75\n", format_unit(measured.offset_unit_near),
                      format_unit(measured.offset_unit_far));
  text += fmt::format("        reference > 1   {}\n", measured.clamps_reference ? "clamped to 1" : "not clamped");
  return text;
}

std::string format_slope(double ratio) {
  constexpr double kTolerance = 0.02;
  const auto is = [&](double value) { return std::abs(ratio - value) < kTolerance; };
  if (is(1.0)) return "max(|dz/dx|, |dz/dy|)";
  if (is(1.25)) return "length(dz/dx, dz/dy)";
  if (is(1.75)) return "|dz/dx| + |dz/dy|";
  return fmt::format("{:.3f} x the larger of two slopes 3:4", ratio);
}

}  // namespace

WeightPrecision measure_pcf_weights(Context&, GLenum depth_format) {
  const Texture map = make_step_map(depth_format);
  SurveyShader shader("survey_compare.frag", {kSamples, 1});
  shader.program().set("u_reference", 0.5f);
  return measure_weights(shader, map);
}

int measure_loop_turns(Context&) {
  constexpr int kTurns = 1 << 20;
  SurveyShader shader("survey_loop.frag", {1, 1});
  shader.program().set("u_turns", kTurns);
  const int turns = static_cast<int>(shader.run().front());
  return turns < kTurns ? turns : 0;
}

GlSurvey survey_gl(Context& context) {
  GlSurvey measured;
  measured.d16 = measure_depth_format(context, GL_DEPTH_COMPONENT16);
  measured.d24 = measure_depth_format(context, GL_DEPTH_COMPONENT24);
  measured.d32f = measure_depth_format(context, GL_DEPTH_COMPONENT32F);
  measured.r32f = measure_color_weights(GL_R32F);
  measured.rg32f = measure_color_weights(GL_RG32F);
  measured.r8_levels = count_r8_levels();
  measured.slope_ratio = measure_slope_ratio();
  measured.timer = check_timer(context);
  measure_functions(measured);
  measured.texel_border_error = measure_texel_border_error();
  measured.loop_turns = measure_loop_turns(context);
  return measured;
}

std::string describe_survey(const GlInfo& info, const GlSurvey& measured) {
  std::string text = fmt::format("{}: {}, {}\n", info.backend, info.renderer, info.version);
  text += format_depth("d16", measured.d16) + format_depth("d24", measured.d24) + format_depth("d32f", measured.d32f);
  text += fmt::format("  r32f  linear weights  {}\n", format_weights(measured.r32f));
  text += fmt::format("  rg32f linear weights  {}\n", format_weights(measured.rg32f));
  text += fmt::format("  r8    linear levels   {}\n", measured.r8_levels);
  text += fmt::format("  polygon offset slope  {}\n", format_slope(measured.slope_ratio));
  text += fmt::format(
      "  timer query           {:.3f} ms where the wall clock has {:.3f} ms; agrees in {:.0f} % of runs: the {} is "
      "used\n",
      measured.timer.query_ms, measured.timer.wall_ms, 100.0 * measured.timer.agreement,
      timer_name(measured.timer.choice()));
  text += fmt::format("  exp over [-80, 80]    within {:.1f} x 2^-24 of its value\n", measured.exp_ulp);
  text += fmt::format("  sin, cos, [0, 2 pi]   within {:.2g}, {:.2g}\n", measured.sin_error, measured.cos_error);
  text += fmt::format("  nearest, 1024 map     wrong texel up to {:.2g} texel from a border\n",
                      measured.texel_border_error);
  text += measured.loop_turns == 0
              ? "  loops                 not ended by the GL in a million turns\n"
              : fmt::format("  loops                 ended by the GL after {} turns, without a word\n",
                            measured.loop_turns);
  return text;
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
