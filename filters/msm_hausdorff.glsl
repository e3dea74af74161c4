/*+++
title = "Moment shadow map, four moments, depth between 0 and 1"
source = "Peters and Klein 2015, Moment Shadow Mapping, I3D, the Hausdorff moment problem; stored in the basis of Peters et al. 2017, Improved Moment Shadow Maps for Translucent Occluders, Soft Shadows and Single Scattering, JCGT 6(1)"
kind = "bound"
store = ["rgba32f", "rgba16"]
combine = "linear"
sample = "linear"
radius_texels = "radius"
bias_texels = 1
[param.radius]
default = 4
min = 0
max = 64
unit = "texels"
text = "half-width of the Gaussian prefilter; wider is softer at no cost to the lookup"
[param.moment_bias]
default = 3e-5
min = 1e-6
max = 1e-1
text = "share of a wide distribution that is mixed in; too small gives noise, too large bleeds light; a 16-bit store takes 1.2e-4 at least"
+++*/
#include "lib/four_moments.glsl"

vec4 encode(EncodeInput e) { return encode_moments(e.depth); }

float visibility(Receiver r) {
  float bias = fit_moment_bias(moment_bias);
  vec4 moments = decode_moments(fetch_map(r, vec2(0.0)), bias);
  float share = share_before_in_range(moments, 2.0 * r.depth - 1.0);
  return 1.0 - unbias_share(share, bias);
}
