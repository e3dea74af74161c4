/*+++
title = "Percentage-closer soft shadows"
source = "Fernando 2005, Percentage-Closer Soft Shadows, SIGGRAPH sketches; taps on the spiral of Vogel 1979, A Better Way to Construct the Sunflower Head, Mathematical Biosciences 44; each tap is biased by its own distance"
kind = "stochastic"
claims = "contact-hardening"
radius_texels = "max_radius"
bias_texels = 1
[param.taps]
default = 16
choices = [4, 8, 16, 32]
const = true
unit = "hardware 2x2 fetches"
text = "points in the disk that is averaged; too few turn the penumbra into noise or bands"
[param.search_taps]
default = 16
choices = [4, 8, 16, 32]
const = true
unit = "fetches"
text = "points among which blockers are searched; too few miss thin ones, and leave the outer penumbra lit"
[param.max_radius]
default = 12.0
min = 0.0
max = 64.0
unit = "texels"
text = "limit of both radii; too small hardens wide penumbrae, too large pads the map and spreads the taps"
[param.rotation]
default = "per-pixel"
choices = ["none", "per-pixel", "interleaved-gradient"]
text = "turn of both disks at each pixel: none shows bands, per-pixel white noise, interleaved-gradient a regular dither"
[disk.disk_points]
count = "taps"
seed = 1
[disk.search_points]
count = "search_taps"
seed = 2
+++*/
const float one_fetch = 0.25;  // texels: a smaller disk is one fetch

float biased_depth(Receiver r, vec2 offset) { return r.depth - dot(r.bias_per_texel, abs(offset)); }

vec2 rotate(vec2 p, float c, float s) { return vec2(c * p.x - s * p.y, s * p.x + c * p.y); }

float visibility(Receiver r) {
  float widening = 0.5 * r.light_size * r.depth_range_ws / r.texel_size_ws;  // the disk's radius, texels per depth
  float search = min(widening * r.depth_unbiased, max_radius);
  if (search < one_fetch) return compare_2x2(r, vec2(0.0), r.depth);
  float turn = 0.0;
  if (rotation == ROTATION_PER_PIXEL) turn = random_turn(r.pixel);
  if (rotation == ROTATION_INTERLEAVED_GRADIENT) turn = interleaved_gradient_turn(r.pixel);
  float c = cos(6.28318530718 * turn);
  float s = sin(6.28318530718 * turn);
  float depths = 0.0;
  float blockers = 0.0;
  for (int i = 0; i < search_taps; ++i) {
    vec2 offset = search * rotate(search_points[i], c, s);
    float depth = fetch_depth(r, offset);
    if (depth < biased_depth(r, offset)) {
      depths += depth;
      blockers += 1.0;
    }
  }
  if (blockers == 0.0) return 1.0;
  float radius = min(widening * (r.depth - depths / blockers), max_radius);
  if (radius < one_fetch) return compare_2x2(r, vec2(0.0), r.depth);
  float sum = 0.0;
  for (int i = 0; i < taps; ++i) {
    vec2 offset = radius * rotate(disk_points[i], c, s);
    sum += compare_2x2(r, offset, biased_depth(r, offset));
  }
  return sum / float(taps);
}
