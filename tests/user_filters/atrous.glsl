/*+++
title = "One random comparison, denoised on the screen"
source = "Dammertz et al. 2010, Edge-Avoiding A-Trous Wavelet Transform for Fast Global Illumination Filtering, HPG; weights by variance: Schied et al. 2017, Spatiotemporal Variance-Guided Filtering, HPG, without their history"
kind = "stochastic"
radius_texels = "radius"
kernel = "disk:radius"
[param.radius]
default = 3.0
min = 0.0
max = 64.0
unit = "texels"
text = "radius of the disk; wider is softer and noisier"
[param.width]
default = 0.5
min = 0.001
max = 100.0
unit = "metres"
text = "from where on nothing is blurred; narrower keeps the noise, wider blurs more than the disk"
[param.deviations]
default = 4.0
min = 0.5
max = 16.0
text = "of noise that a difference may have and still be blurred; too few keep the noise, too many blur edges"
[screen.atrous]
reach = 8
steps = 4
+++*/
#include "lib/screen_blur.glsl"

float visibility(Receiver r) {
  float angle = 6.28318530718 * random_turn(r.pixel), share = random_turn(r.pixel + 4096);
  return compare_2x2(r, radius * sqrt(share) * vec2(cos(angle), sin(angle)), r.depth);
}

// First the variance of 5x5 pixels, then three blurs over 5x5 pixels, each twice as far apart as the blur before.
vec2 atrous(ScreenInput s) {
  ScreenSurface here = load_surface(s, ivec2(0));
  vec2 own = load_screen(s, ivec2(0));
  int stride = 1 << max(s.step - 1, 0);
  float deviation = deviations * sqrt(own.y) + 1e-3;
  float sum = 0.0, squares = 0.0, weights = 0.0, variance = 0.0;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      ivec2 offset = stride * ivec2(x, y);
      vec2 there = load_screen(s, offset);
      if (there.y < 0.0) continue;
      float weight = exp2(-0.5 * float(x * x + y * y));
      if (x != 0 || y != 0) weight *= near_on_surface(here, load_surface(s, offset), width);
      if (s.step > 0) weight *= exp(-abs(there.x - own.x) / deviation);
      sum += weight * there.x;
      squares += weight * there.x * there.x;
      variance += weight * weight * there.y;
      weights += weight;
    }
  }
  float mean = sum / weights;
  if (s.step == 0) return vec2(own.x, max(squares / weights - mean * mean, 0.0));
  return vec2(mean, variance / (weights * weights));
}
