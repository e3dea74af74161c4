/*+++
title = "Contact hardening in one set of taps"
source = "Myers 2021, Shadows of Cold War: A Scalable Approach to Shadowing, SIGGRAPH, Advances in Real-Time Rendering; each of the four texels of a tap weighs as a hardware fetch weighs it. Filament had its like until 2026, and removed it as expensive and of low quality: Agopian, its pull request 10188"
kind = "stochastic"
claims = "contact-hardening"
radius_texels = "max_radius"
bias_texels = 1
[param.taps]
default = 16
choices = [4, 8, 16, 32]
const = true
unit = "gathers"
text = "points in the disk that finds blockers and their share; too few turn the penumbra into noise or bands, the more so the harder it is"
[param.max_radius]
default = 8.0
min = 0.0
max = 64.0
unit = "texels"
text = "limit of the disk's radius; too small hardens wide penumbrae, too large spreads the taps so that narrow ones are noisy"
[param.rotation]
default = "per-pixel"
choices = ["none", "per-pixel", "interleaved-gradient", "blue-noise"]
text = "turn of the disk at each pixel: none shows bands, per-pixel white noise, interleaved-gradient a regular dither, blue-noise one without a pattern"
[disk.disk_points]
count = "taps"
seed = 1
+++*/
#include "lib/penumbra.glsl"

float visibility(Receiver r) {
  float search = min(penumbra_radius(r, r.depth_unbiased), max_radius);
  if (search < one_fetch) return compare_2x2(r, vec2(0.0), r.depth);
  vec2 turn = find_turn(r.pixel);
  float depths = 0.0;
  float blocked = 0.0;
  for (int i = 0; i < taps; ++i) {
    vec2 offset = search * rotate(disk_points[i], turn);
    Corner corner = find_corner(r, offset);
    vec4 depth = gather_depth(r, corner.offset);
    float plane = corner_depth(r, corner.offset, biased_depth(r, offset));
    vec4 weights = corner.weights * vec4(lessThan(depth, vec4(plane)));
    depths += dot(weights, depth);
    blocked += dot(weights, vec4(1.0));
  }
  if (blocked == 0.0) return 1.0;
  float radius = min(penumbra_radius(r, r.depth - depths / blocked), max_radius);
  if (radius < one_fetch) return compare_2x2(r, vec2(0.0), r.depth);
  return clamp(0.5 + (0.5 - blocked / float(taps)) * search / radius, 0.0, 1.0);
}
