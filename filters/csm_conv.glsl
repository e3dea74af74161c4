/*+++
title = "Convolution shadow map"
source = "Annen, Mertens, Bekaert, Seidel and Kautz 2007, Convolution Shadow Maps, Eurographics Symposium on Rendering, eq. 8 and section 4: four terms, damped, scaled by two"
kind = "other"
radius_texels = "radius"
bias_texels = 1
[param.radius]
default = 3
min = 0
max = 31
unit = "texels"
text = "half of the blurring box's side, without its own texel; wider is softer at no cost to the lookup"
[param.damping]
default = 0.5
min = 0.0
max = 4.0
text = "how much the higher terms are damped; too little rings, too much fades contact shadows"
[param.scale]
default = 2.0
min = 1.0
max = 4.0
text = "what the series is multiplied by before it is cut at 1: it is one half where caster and receiver touch; 2 lights such surfaces, and hardens penumbrae"
[pass.cosines]
store = "rgba16f"
steps = "axes"
[pass.sines]
store = "rgba16f"
steps = "axes"
+++*/
// Frequencies of the square wave's Fourier series.
const vec4 frequencies = 3.14159265359 * vec4(1.0, 3.0, 5.0, 7.0);
const vec4 places = vec4(1.0, 2.0, 3.0, 4.0) / 4.0;

// `begun` on the first step, then the mean along one axis: TAP is a texel of the map before.
#define BOX_MEAN(begun, TAP)                                                                  \
  if (p.step == 0) return begun;                                                              \
  vec4 sum = TAP(p.texel - radius * p.direction);                                             \
  for (int i = 1 - radius; i <= radius; ++i) sum += TAP(p.texel + i * p.direction);           \
  return sum / float(2 * radius + 1);

vec4 cosines(PassInput p) { BOX_MEAN(cos(frequencies * load_depth(p.texel)), load_cosines) }

vec4 sines(PassInput p) { BOX_MEAN(sin(frequencies * load_depth(p.texel)), load_sines) }

float visibility(Receiver r) {
  if (r.depth > 1.0) return 0.0;  // the series repeats itself
  if (any(notEqual(r.uv, clamp(r.uv, 0.0, 1.0)))) return 1.0;
  vec4 angles = frequencies * r.depth;
  vec4 weights = exp(-damping * places * places) / frequencies;
  vec4 waves = cos(angles) * fetch_sines(r, vec2(0.0)) - sin(angles) * fetch_cosines(r, vec2(0.0));
  return clamp(scale * (0.5 + 2.0 * dot(weights, waves)), 0.0, 1.0);
}
