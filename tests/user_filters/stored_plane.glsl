/*+++
title = "Stores depth and slope, reads the sampler itself"
source = "a test"
kind = "other"
store = "rgba32f"
combine = "linear"
sample = "nearest"
radius_texels = 1
[param.invert]
default = false
text = "swaps lit and blocked"
[param.levels]
default = 4
min = 1
max = 8
const = true
text = "steps of the result"
+++*/
vec4 encode(EncodeInput e) { return vec4(e.depth, e.depth_per_texel, 1.0); }

float visibility(Receiver r) {
  vec4 stored = texture(map_stored, r.uv);
  float lit = r.depth <= stored.x ? 1.0 : 0.0;
  lit = round(lit * float(levels)) / float(levels);
  return invert ? 1.0 - lit : lit;
}
