/*+++
title = "Exponential variance shadow map, positive warp, with any exponent"
source = "Lauritzen and McCool 2008, Layered Variance Shadow Maps, Graphics Interface; teaching version: nothing fits the exponent to the store, so that 16 bits overflow above 5.54"
kind = "bound"
teaching = true
store = ["rg32f", "rg16f"]
combine = "linear"
sample = "linear"
radius_texels = "radius"
bias_texels = 1
moments = true
exponent = "c"
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
text = "exponent of the warp; too small bleeds light, too large lights penumbrae, and above 5.54 overflows a 16-bit store"
[param.min_deviation]
default = 3e-4
min = 0.0
max = 1e-1
unit = "depth"
text = "least standard deviation; too small gives acne, too large fades contact shadows"
+++*/
#include "lib/warped_variance.glsl"

vec4 encode(EncodeInput e) {
  float up = warp_up(e.depth, c);
  return vec4(up, up * up, 0.0, 0.0);
}

float visibility(Receiver r) {
  return bound_light(fetch_map(r, vec2(0.0)).xy, warp_up(r.depth, c), c, min_deviation);
}
