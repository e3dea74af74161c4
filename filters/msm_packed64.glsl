/*+++
title = "Moment shadow map, four moments in 64 bits"
source = "after Peters 2017, Non-linearly Quantized Moment Shadow Maps, HPG, with our own formulas and numbers of bits, from Gauss quadrature; the light: Peters and Klein 2015, Moment Shadow Mapping, I3D, the Hamburger moment problem"
kind = "other"
store = "rgba32f"
combine = "linear"
radius_texels = "radius"
bias_texels = 1
[param.radius]
default = 4
min = 1
max = 64
unit = "texels"
text = "half-width of the Gaussian prefilter; wider is softer at no cost to the lookup"
[param.moment_bias]
default = 3e-5
min = 1e-6
max = 1e-1
text = "share of a wide distribution that is mixed in before moments are packed; too small gives noise, too large bleeds light"
[param.lookup]
default = "dithered"
choices = ["dithered", "bilinear"]
text = "of the four texels around a receiver, which hardware cannot average: one by chance, with blue noise, or the mean of all four, which costs four times as much"
[pass.codes]
store = "rg32ui"
+++*/
const vec4 levels = vec4(65536.0);

uvec4 load_packed(ivec2 texel) {
  uvec2 code = load_codes(texel).xy;
  return uvec4(code.x & 65535u, code.x >> 16, code.y & 65535u, code.y >> 16);
}

#include "lib/packed_moments.glsl"

vec4 encode(EncodeInput e) { return encode_moments(e.depth); }

uvec4 codes(PassInput p) {
  uvec4 code = pack_moments(decode_moments(load_map(p.texel), moment_bias));
  return uvec4(code.x | code.y << 16, code.z | code.w << 16, 0u, 0u);
}

float visibility(Receiver r) { return packed_light(r); }
