// What filters share that read means over boxes as wide as the penumbra from a summed-area table; they have a parameter
// `max_radius`. filters/penumbra.h does the same.
#include "lib/penumbra_radius.glsl"
#include "lib/summed_area.glsl"

const float least_half_width = 0.5;   // texels: the box is never smaller than a texel
const float box_of_disk = 0.8660254;  // half-width of the box with the standard deviation of a disk of radius 1

int longest_side() { return 2 * max_radius + 3; }

// The half-width of the box for a blocker so far above the receiver in depth, texels.
float half_width(Receiver r, float depth_above) { return box_of_disk * penumbra_radius(r, depth_above); }

// That of the box in which all blockers are.
float search_half_width(Receiver r) {
  return clamp(half_width(r, r.depth_unbiased), least_half_width, max(float(max_radius), least_half_width));
}

MOMENTS mean_around(Receiver r, float half_width) {
  vec2 place = r.uv / map_texel_uv;
  return mean_moments(place - half_width, place + half_width, longest_side());
}
