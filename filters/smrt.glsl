/*+++
title = "Shadow map ray tracing"
source = "Epic Games 2022, Unreal Engine 5, the console variables r.Shadow.Virtual.SMRT.*: its numbers of rays and of steps; in one map, and from the receiver to the light, with steps that grow with the height, as penumbrae do"
kind = "stochastic"
claims = "contact-hardening"
radius_texels = "max_radius"
bias_texels = 1
[param.rays]
default = 7
choices = [1, 4, 7, 16, 32]
const = true
text = "rays to points of the light; too few turn the penumbra into noise, and 1 goes to the light's centre"
[param.steps]
default = 8
choices = [4, 8, 16, 32]
const = true
unit = "fetches"
text = "places along a ray, over the whole range of depth; too few read the map beside the ray, so that penumbrae are as wide as the step and not as the blocker has it"
[param.thickness]
default = 2.0
min = 1.0
max = 64.0
unit = "steps"
text = "how far a surface of the map is taken to reach down from where it lies; 1 leaves no gap between steps, but lets rays slip through slopes; too little lights lines in shadows where one occluder's edge lies above another, too much darkens what is below an edge"
[param.max_radius]
default = 12.0
min = 0.0
max = 64.0
unit = "texels"
text = "limit of how far rays stray from the receiver; too small hardens wide penumbrae, too large pads the map"
[param.rotation]
default = "per-pixel"
choices = ["none", "per-pixel", "interleaved-gradient", "blue-noise"]
text = "turn of the rays at each pixel: none shows bands, per-pixel white noise, interleaved-gradient a regular dither, blue-noise one without a pattern"
[disk.disk_points]
count = "rays"
seed = 1
+++*/
#include "lib/penumbra.glsl"

// How far a step lies above any receiver, in depth: the same for all, so that a shadow that moves stays as it is.
float height_of(float step) {
  float share = step / float(steps);
  return share * share;
}

// 1 where a surface of the map, which reaches down from where it lies, crosses a step of a ray that begins at the
// step's height and is read at `within` of it; else 0. Whatever lies above the last step is crossed by it.
float block(Receiver r, vec2 point, int step, float within) {
  vec2 offset = min(penumbra_radius(r, height_of(float(step) + within)), max_radius) * point;
  float depth = fetch_depth(r, offset);
  float start = nearest_depth(r, offset, biased_depth(r, offset));
  bool is_beyond = step < steps - 1 && depth < start - height_of(float(step) + thickness);
  return depth >= start - height_of(float(step)) || is_beyond ? 0.0 : 1.0;
}

float visibility(Receiver r) {
  vec2 turn = find_turn(r.pixel);
  float lit = float(rays);
  for (int i = 0; i < rays; ++i) {
    vec2 point = rotate(disk_points[i], turn);
    float within = fract((float(i) + 0.5) * 0.61803399);  // rays read their steps at other places, a golden ratio on
    float blocked = 0.0;
    for (int k = 0; k < steps && blocked == 0.0; ++k) blocked = block(r, point, k, within);
    lit -= blocked;
  }
  return lit / float(rays);
}
