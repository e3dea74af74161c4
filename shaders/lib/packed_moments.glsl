// Four moments of depth as whole numbers: two depths, the share of the farther one, and how far depths spread around
// them. The idea is that of Peters 2017, Non-linearly Quantized Moment Shadow Maps, HPG; the formulas are our own, from
// Gauss quadrature. filters/moments.h does the same.
//
// A filter that includes this says in `levels` how many values each number can take, declares the parameters `lookup`
// and `moment_bias`, and defines `uvec4 load_packed(ivec2 texel)`.
#include "lib/four_moments.glsl"

const float even_spread = 0.05;             // depths spread evenly have it: their part is one half
const vec2 least_parts = vec2(2e-4, 1e-6);  // of share and spread, which are never quite 0 or 1

const vec4 last = levels - 1.0;
const float margin = 1.25 / last.x;  // half a step, by which rounding may have moved a surface, and a little more

// The only distribution over two depths that has the first three of the moments, and what of the fourth it lacks: the
// mean square of the polynomial that is 0 at both depths. That is stored in units of their distance, so that it is 0
// where there are no other depths, and alike for surfaces of any slope. The share keeps the mean, whichever way the
// depths were rounded.
uvec4 pack_moments(vec4 b) {
  float variance = b.y - b.x * b.x;
  float tilt = b.z - b.x * b.y;
  float middle = 0.5 * tilt / variance;
  float reach = sqrt((middle - b.x) * (middle - b.x) + variance);
  vec2 steps = floor((0.5 + 0.5 * (middle + vec2(-reach, reach))) * last.xy + 0.5);
  steps.x = clamp(steps.x, 0.0, last.x - 1.0);
  steps.y = clamp(steps.y, steps.x + 1.0, last.y);
  vec2 depths = 2.0 * steps / last.xy - 1.0;
  float share = clamp((b.x - depths.x) / (depths.y - depths.x), 0.0, 1.0);
  float rest = max(b.w - b.y * b.y - 2.0 * middle * tilt, 0.0);
  float spread = rest / (rest + even_spread * (16.0 * reach * reach * reach * reach));
  return uvec4(steps, floor(share * last.z + 0.5), ceil(sqrt(spread) * last.w));
}

// The least share of any distribution with these moments that lies before x. In units in which the nearer depth is 0
// and the farther one 1, the polynomial of `solve_moments` is a sum of what both depths and the rest contribute.
float share_before_packed(uvec4 code, float x) {
  vec2 depths = 2.0 * vec2(code.xy) / last.xy - 1.0;
  float place = (x - margin - depths.x) / (depths.y - depths.x);
  vec2 roots = vec2(code.zw) / last.zw;
  vec2 parts = clamp(vec2(roots.x, roots.y * roots.y), least_parts, 1.0 - least_parts);
  float rest = even_spread * parts.y / (1.0 - parts.y);
  float square = place * (place - 1.0) / rest;
  float least = (1.0 - place) / (1.0 - parts.x);
  return share_of_points(vec4(parts.x), place, vec3(least, place / parts.x - least - square, square));
}

// The light that a texel lets through, with the receiver's bias widened by its distance.
float light_through(Receiver r, ivec2 texel) {
  vec2 way = abs(vec2(texel) + 0.5 - r.uv / map_texel_uv);
  float x = 2.0 * (r.depth - dot(r.bias_per_texel, way)) - 1.0;
  return 1.0 - unbias_share(share_before_packed(load_packed(texel), x), moment_bias + least_parts.x);
}

// Of the four texels around the receiver, which cannot be averaged before they are unpacked: their mean, or one, as
// often as the mean counts it.
float packed_light(Receiver r) {
  if (any(notEqual(r.uv, clamp(r.uv, 0.0, 1.0)))) return step(r.depth, 1.0);
  vec2 place = r.uv / map_texel_uv - 0.5;
  ivec2 texel = ivec2(floor(place));
  vec2 part = place - floor(place);
  if (lookup == LOOKUP_BILINEAR) {
    float low = mix(light_through(r, texel), light_through(r, texel + ivec2(1, 0)), part.x);
    float high = mix(light_through(r, texel + ivec2(0, 1)), light_through(r, texel + 1), part.x);
    return mix(low, high, part.y);
  }
  float turn = blue_noise_turn(r.pixel);
  bool right = turn < part.x;
  turn = right ? turn / part.x : (turn - part.x) / (1.0 - part.x);
  return light_through(r, texel + ivec2(right, turn < part.y));
}
