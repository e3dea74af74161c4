/*+++
title = "Exponential variance shadow map, positive warp"
source = "Lauritzen and McCool 2008, Layered Variance Shadow Maps, Graphics Interface; light-bleeding reduction: Lauritzen 2007, GPU Gems 3, ch. 8"
kind = "bound"
store = ["rg32f", "rg16f"]
combine = "linear"
sample = "linear"
radius_texels = "radius"
bias_texels = 1
moments = true
bound_at_zero = "bleed_reduction"
[param.radius]
default = 4
min = 0
max = 64
unit = "texels"
text = "half-width of the Gaussian prefilter; wider is softer at no cost to the lookup"
[param.c]
default = 10.0
min = 1.0
max = 42.0
unit = "1/half the depth range"
text = "exponent of the warp; too small bleeds light, too large lights penumbrae; a 16-bit store takes 5.54 at most"
[param.min_deviation]
default = 3e-4
min = 0.0
max = 1e-1
unit = "depth"
text = "least standard deviation; too small gives acne, too large fades contact shadows"
[param.bleed_reduction]
default = 0.15
min = 0.0
max = 0.99
text = "share of the dark end that is cut to black; hides light bleeding, and hardens penumbrae; 0 is the textbook form, and alone an upper bound"
+++*/
#include "lib/warped_variance.glsl"

vec4 encode(EncodeInput e) {
  float up = warp_up(e.depth, fit_exponent(c));
  return vec4(up, up * up, 0.0, 0.0);
}

float visibility(Receiver r) {
  float c_up = fit_exponent(c);
  vec4 moments = fetch_map(r, vec2(0.0));
  float light = bound_light(moments.xy, warp_up(r.depth, c_up), c_up, min_deviation);
  return max(light - bleed_reduction, 0.0) / (1.0 - bleed_reduction);
}
