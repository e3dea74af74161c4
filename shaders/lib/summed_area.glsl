// Means of two or four moments over boxes of texels, from a summed-area table in whole numbers (Lauritzen 2007, GPU
// Gems 3, ch. 8): sums wrap around at 2^32, and the sum of a box is right as long as it stays below that itself. The
// table is the map of a pass `summed` with store = "rg32ui" or "rgba32ui" and steps = "prefix"; `side` is the longest
// side of a box in texels.
// A filter that stores four moments defines MOMENTS as vec4 and MOMENT_SUMS as uvec4 before it includes this.
#ifndef MOMENTS
#define MOMENTS vec2
#define MOMENT_SUMS uvec2
#endif

vec4 encode(EncodeInput e);

// Steps from moment 0 to moment 1.
float moment_steps(int side) { return min(16777216.0, floor(4.0e9 / float(side * side))); }

// What the pass `summed` writes: the moments in the encoded map, and then their sums.
uvec4 sum_moments(PassInput p, int side) {
  if (p.step == 0) return uvec4(clamp(load_map(p.texel), 0.0, 1.0) * moment_steps(side) + 0.5);
  uvec4 sum = load_summed(p.texel);
  for (int i = 1; i < 4; ++i) {
    ivec2 before = p.texel - i * p.stride * p.direction;
    if (min(before.x, before.y) >= 0) sum += load_summed(before);
  }
  return sum;
}

// The moments of a box between two corners, in texels from the map's lower left. A texel counts by the part of it that
// lies in the box. What lies outside the map has depth 1. Sums of texels that are there in whole are differences of
// whole numbers; they are weighted after that, and by the same weights as their areas, so that rounding moves both.
MOMENTS mean_moments(vec2 low, vec2 high, int side) {
  ivec2 first = ivec2(floor(low)) - 1, last = ivec2(floor(high)) - 1, end = textureSize(map_summed, 0) - 1;
  ivec2 places[4] = ivec2[](first, first + 1, last, last + 1);
  vec2 parts[4] = vec2[](1.0 - fract(low), fract(low), 1.0 - fract(high), fract(high));
  MOMENT_SUMS sums[16];
  for (int i = 0; i < 16; ++i) {
    ivec2 texel = ivec2(places[i & 3].x, places[i >> 2].y);
    sums[i] = min(texel.x, texel.y) < 0 ? MOMENT_SUMS(0) : MOMENT_SUMS(load_summed(texel));
  }
  MOMENTS outside = MOMENTS(encode(EncodeInput(1.0, vec2(0.0)))), moments = MOMENTS(0.0);
  float area = 0.0;
  for (int i = 0; i < 16; ++i) {
    int left = i & 1, right = 2 + (i >> 1 & 1), bottom = i >> 2 & 1, top = 2 + (i >> 3);
    ivec2 from = ivec2(places[left].x, places[bottom].y), to = ivec2(places[right].x, places[top].y);
    ivec2 inside = clamp(to, ivec2(-1), end) - clamp(from, ivec2(-1), end);
    MOMENT_SUMS sum = sums[4 * top + right] - sums[4 * top + left] - sums[4 * bottom + right] + sums[4 * bottom + left];
    float whole = float((to.x - from.x) * (to.y - from.y));
    float weight = parts[left].x * parts[right].x * parts[bottom].y * parts[top].y;
    moments += weight * (MOMENTS(sum) / moment_steps(side) + (whole - float(inside.x * inside.y)) * outside);
    area += weight * whole;
  }
  return moments / area;
}
