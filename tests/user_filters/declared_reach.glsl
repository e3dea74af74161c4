/*+++
title = "Every kind of read, exactly as far as declared"
source = "a test of what makes a filter suspect"
kind = "other"
store = "r32f"
combine = "linear"
sample = "linear"
radius_texels = "radius"
[param.radius]
default = 2
min = 0
max = 8
text = "half-width of the prefilter and of the taps"
+++*/
vec4 encode(EncodeInput e) { return vec4(e.depth); }

float visibility(Receiver r) {
  float far = float(radius);
  float sum = compare_2x2(r, vec2(far, -far), r.depth) + compare_nearest(r, vec2(-far, far + 0.5), r.depth);
  sum += r.depth <= fetch_depth(r, vec2(far + 0.5)) ? 1.0 : 0.0;
  return (sum + (r.depth <= fetch_map(r, vec2(0.0)).x ? 1.0 : 0.0)) / 4.0;
}
