/*+++
title = "Moment soft shadow map"
source = "Peters, Muenstermann, Wetzstein and Klein 2016, Beyond Hard Shadows: Moment Shadow Maps for Single Scattering, Soft Shadows and Translucent Occluders, I3D; and 2017, Improved Moment Shadow Maps, JCGT 6(1), with their blockers as points of the distribution, and penumbrae as in vssm; summed-area table: Lauritzen 2007, GPU Gems 3, ch. 8"
kind = "other"
claims = "contact-hardening"
store = "rgba32f"
radius_texels = "max_radius"
bias_texels = 1
[param.max_radius]
default = 12
min = 0
max = 30
unit = "texels"
text = "limit of the box's half-width; too small hardens wide penumbrae, too large pads the map"
[param.moment_bias]
default = 1.2e-4
min = 1e-6
max = 1e-1
text = "share of a wide distribution that is mixed in; too small gives noise, too large bleeds light"
[pass.summed]
store = "rgba32ui"
steps = "prefix"
+++*/
#define MOMENTS vec4
#define MOMENT_SUMS uvec4
#include "lib/four_moments.glsl"
#include "lib/penumbra_box.glsl"

vec4 encode(EncodeInput e) { return encode_moments(e.depth); }

uvec4 summed(PassInput p) { return sum_moments(p, longest_side()); }

float visibility(Receiver r) {
  float x = 2.0 * r.depth - 1.0;
  float search = search_half_width(r);
  vec4 around = decode_moments(mean_around(r, search), moment_bias);
  vec3 c = solve_moments(around, x);
  if (unbias_share(share_of_points(around, x, c), moment_bias) <= 0.0) return 1.0;
  float to_blockers = 0.5 * distance_to_blockers(around, x, c);
  float width = clamp(half_width(r, to_blockers), least_half_width, search);
  vec4 moments = decode_moments(mean_around(r, width), moment_bias);
  return 1.0 - unbias_share(share_before(moments, x), moment_bias);
}
