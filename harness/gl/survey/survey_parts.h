#pragma once

#include "harness/gl/survey/survey.h"

namespace shadowbench::gl {

// The experiments that survey_gl consists of, each for itself. All require a current context.

/// Measures the weights of hardware PCF on a map of this depth format.
WeightPrecision measure_pcf_weights(GLenum depth_format);
/// Measures the weights of linear filtering of a colour format.
WeightPrecision measure_color_weights(GLenum format);
/// Counts the values that linear filtering yields between the texels 0 and 255 of R8.
int count_r8_levels();
/// Whether a reference above 1 is compared as 1.
bool detect_clamped_reference(GLenum depth_format);
/// Returns by how much glPolygonOffset(factor 0, units 1) moves a surface of constant depth.
double measure_offset_unit(GLenum depth_format, float depth);
/// Returns the slope that glPolygonOffset's factor multiplies, as a multiple of the larger of two slopes 3:4.
double measure_slope_ratio();
/// Fills exp_ulp, sin_error and cos_error.
void measure_functions(GlSurvey& measured);
/// Returns the farthest distance from a texel border, in texels of a 1024 map, at which the wrong texel is taken.
double measure_texel_border_error();

}  // namespace shadowbench::gl
