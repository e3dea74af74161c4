#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/gl/sampler.h"
#include "harness/gl/survey/survey_parts.h"
#include "harness/gl/survey/survey_shader.h"

namespace shadowbench::gl {
namespace {

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

}  // namespace

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

int measure_loop_turns(Context&) {
  constexpr int kTurns = 1 << 20;
  SurveyShader shader("survey_loop.frag", {1, 1});
  shader.program().set("u_turns", kTurns);
  const int turns = static_cast<int>(shader.run().front());
  return turns < kTurns ? turns : 0;
}

}  // namespace shadowbench::gl
