/*+++
title = "Variance soft shadow map"
source = "Yang, Dong, Feng, Seidel and Kautz 2010, Variance Soft Shadow Mapping, Computer Graphics Forum 29, eq. 5 and 6, without their subdivision of the kernel; summed-area table: Lauritzen 2007, GPU Gems 3, ch. 8"
kind = "other"
claims = "contact-hardening"
store = "rg32f"
radius_texels = "max_radius"
bias_texels = 1
moments = true
variance_floor = "min_variance"
[param.max_radius]
default = 12
min = 0
max = 30
unit = "texels"
text = "limit of the box's half-width; too small hardens wide penumbrae, too large pads the map"
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
default = 0.1
min = 0.0
max = 0.99
text = "share of the dark end that is cut to black; hides light bleeding, and hardens penumbrae, which are softer than in vsm; 0 is the textbook form"
[pass.summed]
store = "rg32ui"
steps = "prefix"
+++*/
#include "lib/penumbra_box.glsl"

vec4 encode(EncodeInput e) {
  float within_texel = slope_variance * dot(e.depth_per_texel, e.depth_per_texel);
  return vec4(e.depth, e.depth * e.depth + within_texel, 0.0, 0.0);
}

uvec4 summed(PassInput p) { return sum_moments(p, longest_side()); }

float variance_of(vec2 moments) { return max(moments.y - moments.x * moments.x, min_variance); }

float visibility(Receiver r) {
  float search = search_half_width(r);
  vec2 around = mean_around(r, search);
  float distance = r.depth - around.x;
  if (distance <= 0.0) return 1.0;
  // The mean distance to the blockers, where all that does not block has the receiver's depth and the blocked share is
  // what Chebyshev's inequality leaves.
  float to_blockers = distance + variance_of(around) / distance;
  vec2 moments = mean_around(r, clamp(half_width(r, to_blockers), least_half_width, search));
  distance = r.depth - moments.x;
  if (distance <= 0.0) return 1.0;
  float variance = variance_of(moments);
  float bound = variance / (variance + distance * distance);
  return max(bound - bleed_reduction, 0.0) / (1.0 - bleed_reduction);
}
