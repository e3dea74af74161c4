/*+++
title = "Exponential shadow map"
source = "Annen, Mertens, Seidel, Flerackers and Kautz 2008, Exponential Shadow Maps, Graphics Interface, eq. 5, and its fallback where the receiver is not planar"
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
[param.fallback]
default = "none"
choices = ["none", "percentage-closer"]
text = "what stands in where the filtered test exceeds 1, because texels under the kernel lie behind the receiver: none lights these receivers, percentage-closer compares every texel of the kernel, and costs as much there"
+++*/
// By how much the filtered test may exceed 1 before it is not believed: less would compare on every sloped plane, more
// would leave light beside edges.
const float fallback_margin = 0.5;

vec4 encode(EncodeInput e) { return vec4(combine == COMBINE_LOG ? c * e.depth : exp(c * e.depth)); }

// Every texel of the kernel, each biased by its own distance.
float compare_kernel(Receiver r) {
  float lit = 0.0;
  float all = 0.0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      vec2 offset = vec2(x, y);
      float weight = exp(-2.0 * dot(offset, offset) / float(max(radius * radius, 1)));
      lit += weight * compare_2x2(r, offset, r.depth - dot(r.bias_per_texel, abs(offset) + 0.5));
      all += weight;
    }
  }
  return lit / all;
}

float visibility(Receiver r) {
  float occluder = fetch_map(r, vec2(0.0)).x;
  float receiver = c * r.depth;
  float lit = combine == COMBINE_LOG ? exp(occluder - receiver) : occluder * exp(-receiver);
  if (fallback == FALLBACK_PERCENTAGE_CLOSER && lit > 1.0 + fallback_margin) return compare_kernel(r);
  return min(lit, 1.0);
}
