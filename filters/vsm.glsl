/*+++
title = "Variance shadow map"
source = "Donnelly and Lauritzen 2006, Variance Shadow Maps, I3D, eq. 5; slope variance and light-bleeding reduction: Lauritzen 2007, GPU Gems 3, ch. 8"
kind = "bound"
store = ["rg32f", "rg16f"]
combine = "linear"
sample = "linear"
radius_texels = "radius"
bias_texels = 1
moments = true
variance_floor = "min_variance"
bound_at_zero = "bleed_reduction"
[param.radius]
default = 4
min = 0
max = 64
unit = "texels"
text = "half-width of the Gaussian prefilter; wider is softer at no cost to the lookup, and bleeds more light"
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
+++*/
vec4 encode(EncodeInput e) {
  float within_texel = slope_variance * dot(e.depth_per_texel, e.depth_per_texel);
  return vec4(e.depth, e.depth * e.depth + within_texel, 0.0, 0.0);
}

float visibility(Receiver r) {
  vec2 moments = fetch_map(r, vec2(0.0)).xy;
  float distance = r.depth - moments.x;
  if (distance <= 0.0) return 1.0;
  float variance = max(moments.y - moments.x * moments.x, min_variance);
  float bound = variance / (variance + distance * distance);
  return max(bound - bleed_reduction, 0.0) / (1.0 - bleed_reduction);
}
