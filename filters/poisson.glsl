/*+++
title = "Poisson-disk PCF"
source = "Cook 1986, Stochastic Sampling in Computer Graphics, ACM TOG 5(1); taps by default not by throwing darts, but on the spiral of Vogel 1979, A Better Way to Construct the Sunflower Head, Mathematical Biosciences 44, as evenly spread as Poisson-disk points and not crowded at the rim"
kind = "stochastic"
radius_texels = "radius"
[param.taps]
default = 16
choices = [4, 5, 8, 16, 32]
const = true
unit = "hardware 2x2 fetches"
text = "points in the disk; too few turn the penumbra into noise or bands; 5 with rotation=interleaved-gradient are what three.js draws since 2025 (its pull requests 32303 and 32381)"
[param.radius]
default = 3.0
min = 0.0
max = 64.0
unit = "texels"
text = "radius of the disk; wider is softer, and needs more taps and more bias"
[param.rotation]
default = "per-pixel"
choices = ["none", "per-pixel", "interleaved-gradient", "blue-noise"]
text = "turn of the disk at each pixel: none shows bands, per-pixel white noise, interleaved-gradient a regular dither, blue-noise one without a pattern"
[param.pattern]
default = "vogel"
choices = ["vogel", "stratified", "blue-noise", "spiral"]
text = "how points are spread: vogel on a sunflower's spiral, stratified one anywhere in each cell of a grid, blue-noise far from each other, spiral with even steps inwards (Jimenez 2014), so that they crowd in the middle"
[param.bail]
default = "none"
choices = ["none", "agree"]
text = "agree ends the lookup where the pattern's last four taps, with vogel those nearest the rim, are all lit or all blocked (Calinou 2021, Godot's pull request 54160); faster, and shadows thinner than the disk get holes"
[disk.disk_points]
count = "taps"
seed = 1
pattern = "pattern"
+++*/
#include "lib/disk.glsl"
#include "lib/early_bail.glsl"

float visibility(Receiver r) {
  vec2 turn = radius * find_turn(r.pixel);
  float sum = 0.0;
  for (int i = 0; i < taps; ++i) {
    sum += compare_2x2(r, rotate(disk_points[order_tap(i, taps)], turn), r.depth);
    if (agrees(i, sum)) return sum / float(first_taps);
  }
  return sum / float(taps);
}
