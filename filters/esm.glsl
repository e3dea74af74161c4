/*+++
title = "Exponential shadow map"
source = "Annen, Mertens, Seidel, Flerackers and Kautz 2008, Exponential Shadow Maps, Graphics Interface, eq. 5"
kind = "bound"
store = ["r32f", "r16f"]
combine = ["linear", "log"]
sample = "linear"
radius_texels = "radius"
bias_texels = 0
exponent = "c"
[param.radius]
default = 4
min = 0
max = 64
unit = "texels"
text = "half-width of the Gaussian prefilter; wider is softer at no cost to the lookup"
[param.c]
default = 80.0
min = 1.0
max = 2000.0
unit = "1/depth"
text = "exponent; too small fades contact shadows, too large overflows: above 88 in r32f, above 11 in r16f. combine=log has no such limit"
+++*/
vec4 encode(EncodeInput e) { return vec4(combine == COMBINE_LOG ? c * e.depth : exp(c * e.depth)); }

float visibility(Receiver r) {
  float occluder = fetch_map(r, vec2(0.0)).x;
  float receiver = c * r.depth;
  if (combine == COMBINE_LOG) return min(exp(occluder - receiver), 1.0);
  return min(occluder * exp(-receiver), 1.0);
}
