#include "harness/gl/survey/survey.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/gl/survey/survey_parts.h"

namespace shadowbench::gl {
namespace {

DepthFormatSurvey measure_depth_format(GLenum format) {
  constexpr float kNear = 0.25f;
  constexpr float kFar = 0.75f;
  DepthFormatSurvey measured;
  measured.pcf = measure_pcf_weights(format);
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

GlSurvey survey_gl(Context& context) {
  GlSurvey measured;
  measured.d16 = measure_depth_format(GL_DEPTH_COMPONENT16);
  measured.d24 = measure_depth_format(GL_DEPTH_COMPONENT24);
  measured.d32f = measure_depth_format(GL_DEPTH_COMPONENT32F);
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

int measure_pcf_weight_bits(Context&, GLenum depth_format) { return measure_pcf_weights(depth_format).bits; }

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

}  // namespace shadowbench::gl
