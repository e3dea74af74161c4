#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "harness/gl/sampler.h"
#include "harness/gl/survey/survey_parts.h"
#include "harness/gl/survey/survey_shader.h"

namespace shadowbench::gl {
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

}  // namespace

WeightPrecision measure_pcf_weights(GLenum depth_format) {
  const Texture map = make_step_map(depth_format);
  SurveyShader shader("survey_compare.frag", {kSamples, 1});
  shader.program().set("u_reference", 0.5f);
  return measure_weights(shader, map);
}

WeightPrecision measure_color_weights(GLenum format) {
  const Texture map = make_step_map(format);
  SurveyShader shader("survey_filter.frag", {kSamples, 1});
  return measure_weights(shader, map);
}

int count_r8_levels() {
  const Texture map = make_step_map(GL_R8);
  SurveyShader shader("survey_filter.frag", {kSamples, 1});
  return count_distinct(sample(shader, map, kCoarse));
}

bool detect_clamped_reference(GLenum depth_format) {
  Texture map = make_step_map(depth_format);
  map.upload_floats(std::array{1.0f, 1.0f}, 1);
  SurveyShader shader("survey_compare.frag", {1, 1});
  shader.program().set("u_reference", 1.5f);
  return sample(shader, map, kCoarse).front() > 0.5f;
}

}  // namespace shadowbench::gl
