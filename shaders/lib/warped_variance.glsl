// Exponential warps of depth, and what their variance says; filters/moments.h does the same.

// The largest exponent whose squares the store keeps, with room for sums of them in the lookup.
float fit_exponent(float c) { return min(c, store_largest < 1e5 ? 5.54 : 42.0); }

// A receiver outside of the map's depths must not overflow either.
float warp_up(float depth, float c) { return exp(min(c * (2.0 * depth - 1.0), 80.0)); }
float warp_down(float depth, float c) { return -exp(min(-c * (2.0 * depth - 1.0), 80.0)); }

// Cantelli's upper bound of the light, from a mean and the mean of its square. The least deviation is a length in
// depth, stretched as the warp stretches depth here. Everything is divided by the larger number, so that no square
// overflows.
float bound_light(vec2 moments, float warped, float c, float min_deviation) {
  float unit = 1.0 / max(abs(warped), abs(moments.x));
  float mean = moments.x * unit;
  float distance = warped * unit - mean;
  if (distance <= 0.0) return 1.0;
  float least = 2.0 * c * min_deviation * warped * unit;
  float variance = max(moments.y * unit * unit - mean * mean, least * least);
  return variance / (variance + distance * distance);
}
