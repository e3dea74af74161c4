/*+++
title = "Variance shadow map over a summed-area table"
source = "Lauritzen 2007, Summed-Area Variance Shadow Maps, GPU Gems 3, ch. 8; prefix sums with radix 4: Hensley et al. 2005, Fast Summed-Area Table Generation and its Applications, Computer Graphics Forum 24"
kind = "bound"
store = "rg32f"
radius_texels = "radius"
bias_texels = 1
moments = true
variance_floor = "min_variance"
bound_at_zero = "bleed_reduction"
[param.radius]
default = 3
min = 0
max = 31
unit = "texels"
text = "half of the box's side, without its own texel; wider is softer at no cost at all, and bleeds more light"
[param.min_variance]
default = 1e-5
min = 0.0
max = 1e-1
unit = "depth^2"
text = "lower bound on the variance; too small gives acne, too large fades contact shadows"
[param.slope_variance]
default = 0.25
min = 0.0
max = 1.0
unit = "texels^2"
text = "variance of the places within a texel, as which the stored surface's slope counts; too small gives acne, 0 is the textbook form"
[param.bleed_reduction]
default = 0.3
min = 0.0
max = 0.99
text = "share of the dark end that is cut to black; hides light bleeding, and hardens penumbrae; 0 is the textbook form, and alone an upper bound"
[pass.summed]
store = "rg32ui"
steps = "prefix"
+++*/
#include "lib/summed_area.glsl"

vec4 encode(EncodeInput e) {
  float within_texel = slope_variance * dot(e.depth_per_texel, e.depth_per_texel);
  return vec4(e.depth, e.depth * e.depth + within_texel, 0.0, 0.0);
}

int longest_side() { return 2 * radius + 3; }

uvec4 summed(PassInput p) { return sum_moments(p, longest_side()); }

float visibility(Receiver r) {
  vec2 place = r.uv / map_texel_uv;
  float reach = float(radius) + 0.5;
  vec2 moments = mean_moments(place - reach, place + reach, longest_side());
  float distance = r.depth - moments.x;
  if (distance <= 0.0) return 1.0;
  float variance = max(moments.y - moments.x * moments.x, min_variance);
  float bound = variance / (variance + distance * distance);
  return max(bound - bleed_reduction, 0.0) / (1.0 - bleed_reduction);
}
