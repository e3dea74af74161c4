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
choices = ["none", "per-pixel", "interleaved-gradient", "blue-noise"]
text = "turn of both disks at each pixel: none shows bands, per-pixel white noise, interleaved-gradient a regular dither, blue-noise one without a pattern"
[param.read]
default = "bilinear"
choices = ["bilinear", "nearest", "interpolated"]
text = "what a tap of the average compares: bilinear 2x2 texels, weighted by the hardware; nearest one texel, so that edges are stepped and noisier; interpolated, in the search too, one depth between four texels, which widens casters by up to a texel"
[param.bail]
default = "none"
choices = ["none", "agree"]
text = "agree ends the search where none of its four taps nearest the rim blocks, and the average where the four there are all lit or all blocked (Calinou 2021, Godot's pull request 54160); faster, and shadows thinner than the disks get holes"
[param.screen]
default = "none"
choices = ["none", "bilateral"]
text = "bilateral blurs the picture along its rows and columns as far as the penumbra is wide, within surfaces (Gumbau et al. 2010, Screen Space Soft Shadows, GPU Pro); few taps then suffice"
[screen.bilateral]
reach = 4
steps = 2
[disk.disk_points]
count = "taps"
seed = 1
[disk.search_points]
count = "search_taps"
seed = 2
+++*/
#include "lib/early_bail.glsl"
#include "lib/penumbra.glsl"
#include "lib/screen_blur.glsl"

// The depth that a tap of the search reads, and the one that it blocks if it is nearer.
vec2 read_tap(Receiver r, vec2 offset) {
  float z = biased_depth(r, offset);
  if (read != READ_INTERPOLATED) return vec2(fetch_depth(r, offset), nearest_depth(r, offset, z));
  Corner corner = find_corner(r, offset);
  return vec2(dot(gather_depth(r, corner.offset), corner.weights), corner_depth(r, corner.offset, z));
}

float compare_tap(Receiver r, vec2 offset) {
  if (read == READ_INTERPOLATED) {
    vec2 tap = read_tap(r, offset);
    return step(tap.y, tap.x);
  }
  float z = biased_depth(r, offset);
  return read == READ_NEAREST ? compare_nearest(r, offset, z) : compare_2x2(r, offset, z);
}

float visibility(Receiver r) {
  float search = min(penumbra_radius(r, r.depth_unbiased), max_radius);
  if (search < one_fetch) return compare_tap(r, vec2(0.0));
  vec2 turn = find_turn(r.pixel);
  float depths = 0.0;
  float blockers = 0.0;
  for (int i = 0; i < search_taps; ++i) {
    vec2 offset = search * rotate(search_points[order_tap(i, search_taps)], turn);
    vec2 tap = read_tap(r, offset);
    if (tap.x < tap.y) {
      depths += tap.x;
      blockers += 1.0;
    }
    if (blockers == 0.0 && agrees(i, blockers)) return 1.0;
  }
  if (blockers == 0.0) return 1.0;
  float radius = min(penumbra_radius(r, r.depth - depths / blockers), max_radius);
  if (radius < one_fetch) return compare_tap(r, vec2(0.0));
  screen_value = radius * r.texel_size_ws;
  float sum = 0.0;
  for (int i = 0; i < taps; ++i) {
    vec2 offset = radius * rotate(disk_points[order_tap(i, taps)], turn);
    sum += compare_tap(r, offset);
    if (agrees(i, sum)) return sum / float(first_taps);
  }
  return sum / float(taps);
}

const int blur_reach = 4;
const float blur_share = 0.5;  // of the penumbra's radius

// The penumbra's radius around, and the mean of visibility within a share of it: along the picture's rows, then columns.
vec2 bilateral(ScreenInput s) {
  ivec2 axis = s.step == 0 ? ivec2(1, 0) : ivec2(0, 1);
  vec2 own = load_screen(s, ivec2(0));
  float radii = 0.0;
  float found = 0.0;
  for (int i = -blur_reach; i <= blur_reach; i += 2) {
    float radius = load_screen(s, i * axis).y;
    if (radius <= 0.0) continue;
    radii += radius;
    found += 1.0;
  }
  if (found == 0.0) return own;
  float radius = radii / found;
  ScreenSurface here = load_surface(s, ivec2(0));
  float sum = own.x;
  float weights = 1.0;
  for (int i = -blur_reach; i <= blur_reach; ++i) {
    vec2 there = load_screen(s, i * axis);
    if (i == 0 || there.y < 0.0) continue;
    float weight = near_on_surface(here, load_surface(s, i * axis), blur_share * radius);
    sum += weight * there.x;
    weights += weight;
  }
  return vec2(sum / weights, radius);
}
