/*+++
title = "Exponential variance soft shadow map"
source = "Agopian 2026, Filament's pull request 10188: PCSS over the mip levels of an exponential variance map; blockers' depth: Yang et al. 2010, Variance Soft Shadow Mapping, Computer Graphics Forum 29, eq. 5, here of the negative warp, in which blockers outweigh what they shadow; warps: Lauritzen and McCool 2008, Layered Variance Shadow Maps"
kind = "other"
claims = "contact-hardening"
store = "rgba32f"
radius_texels = "max_radius"
bias_texels = 1
moments = true
[param.taps]
default = 5
choices = [1, 5, 8]
const = true
unit = "pairs of fetches"
text = "points in the disk, each read from the level whose texels share it; 1 shows the texels of wide penumbrae, more cost more"
[param.max_radius]
default = 24.0
min = 0.0
max = 64.0
unit = "texels"
text = "how far texels are read, which is up to twice a penumbra's radius; too small hardens wide penumbrae, too large pads the map"
[param.c]
default = 40.0
min = 1.0
max = 42.0
unit = "1/half the depth range"
text = "exponent of the warp; larger bleeds less light"
[param.c_down]
default = 5.0
min = 1.0
max = 42.0
unit = "1/half the depth range"
text = "exponent of the negative warp, by which blockers are found; larger bleeds less light where near occluders cross, and widens penumbrae below occluders of several depths"
[param.min_deviation]
default = 3e-4
min = 0.0
max = 1e-1
unit = "depth"
text = "least standard deviation; too small gives acne, too large fades contact shadows"
[param.bleed_reduction]
default = 0.0
min = 0.0
max = 0.99
text = "share of the dark end that is cut to black; hides light bleeding, and hardens penumbrae; 0 is the textbook form"
[param.rotation]
default = "interleaved-gradient"
choices = ["none", "per-pixel", "interleaved-gradient", "blue-noise"]
text = "turn of the disk at each pixel: none shows the taps, per-pixel white noise, interleaved-gradient a regular dither, blue-noise one without a pattern"
[pass.mips]
store = "rgba32f"
steps = "levels"
[disk.disk_points]
count = "taps"
seed = 1
+++*/
#include "lib/disk.glsl"
#include "lib/penumbra_radius.glsl"
#include "lib/warped_variance.glsl"

const float least_radius = 1.0;  // texels: of a disk as wide as a texel of the map read between texels
const float sure = 2e-3;         // what is lit or blocked to within this around a receiver is so at the receiver

vec4 encode(EncodeInput e) {
  float up = warp_up(e.depth, c), down = warp_down(e.depth, c_down);
  return vec4(up, up * up, down, down * down);
}

vec4 mips(PassInput p) {
  if (p.step == 0) return load_map(p.texel);
  ivec2 t = 2 * p.texel;
  int finer = p.step - 1;
  return 0.25 * (load_mips(t, finer) + load_mips(t + ivec2(1, 0), finer) + load_mips(t + ivec2(0, 1), finer) +
                 load_mips(t + 1, finer));
}

// The mean around a place as if read between texels of this side. Of two levels the variances of the place add up by
// their shares, and they grow with the square of the side. Samplers mix levels as well, but each GL in its own way.
vec4 fetch_wide(Receiver r, vec2 offset, float side) {
  float level = floor(log2(side));
  float coarser = (side * side * exp2(-2.0 * level) - 1.0) / 3.0;
  return mix(fetch_mips_lod(r, offset, level), fetch_mips_lod(r, offset, level + 1.0), coarser);
}

// A texel of side s, read between texels, spreads places with a variance of s^2 / 4 along each axis, a disk of radius R
// with R^2 / 4. Taps share the disk out, and lie so far from its centre that both together are as wide as it.
vec4 fetch_disk(Receiver r, float radius) {
  float side = max(radius * inversesqrt(float(taps)), least_radius);
  vec2 turn = sqrt(max(radius * radius - side * side, 0.0)) * find_turn(r.pixel);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < taps; ++i) sum += fetch_wide(r, rotate(disk_points[i], turn), side);
  return sum / float(taps);
}

float light_of(vec4 moments, float up, float down) {
  return min(bound_light(moments.xy, up, c, min_deviation), bound_light(moments.zw, down, c_down, min_deviation));
}

float visibility(Receiver r) {
  bool is_beyond = r.depth > 1.0;
  // Outside the map its passes repeat its edge.
  if (is_beyond || any(notEqual(r.uv, clamp(r.uv, 0.0, 1.0)))) return is_beyond ? 0.0 : 1.0;
  float up = warp_up(r.depth, c), down = warp_down(r.depth, c_down);
  float search = clamp(penumbra_radius(r, r.depth_unbiased), least_radius, max(0.5 * max_radius, least_radius));
  vec4 around = fetch_wide(r, vec2(0.0), search);
  float lit = light_of(around, up, down);
  if (min(lit, 1.0 - lit) < sure) return round(lit);
  float blockers = down - (down - around.z) / (1.0 - lit);
  float depth = 0.5 - 0.5 * log(-clamp(blockers, -exp(c_down), down)) / c_down;
  float radius = clamp(penumbra_radius(r, r.depth - depth), least_radius, search);
  float light = light_of(fetch_disk(r, radius), up, down);
  return max(light - bleed_reduction, 0.0) / (1.0 - bleed_reduction);
}
