#include "lib/light.glsl"

// What a filter is told of a receiver point; filters/receiver.h documents the fields.
struct Receiver {
  vec3 position_ws; vec3 normal_ws;
  float n_dot_l; vec2 uv; int layer;
  float depth; float depth_unbiased;
  vec2 depth_per_texel;
  float texel_size_ws; float depth_range_ws; float light_size; float view_depth; ivec2 pixel; };

// A surface faces the light where n.l is greater than this; filters/receiver.h has the same number.
const float faces_light = 1e-5;

// A plane may be steep, but not parallel to the light: its bias would have no bound.
vec2 plane_depth_per_texel(vec3 normal_ws, float n_dot_l) {
  vec2 along_map = vec2(dot(normal_ws, light_right_ws), dot(normal_ws, light_up_ws));
  vec2 tangent = along_map / max(n_dot_l, 1e-4);
  return tangent * (texel_size_ws / depth_range_ws);
}

Receiver make_receiver(vec3 position_ws, vec3 normal_ws, float view_depth, ivec2 pixel) {
  Receiver r;
  r.position_ws = position_ws;
  r.normal_ws = normal_ws;
  r.n_dot_l = dot(normal_ws, direction_to_light(position_ws));
  // `precise`: the pass that hands these values to the models must get the very same bits.
  float sin_theta = sqrt(max(1.0 - r.n_dot_l * r.n_dot_l, 0.0));
  precise vec3 offset_ws = position_ws + normal_ws * (bias_normal_texels * texel_size_ws * sin_theta);
  precise vec4 lookup_point = uv_depth_from_world * vec4(offset_ws, 1.0);
  precise vec4 own_point = uv_depth_from_world * vec4(position_ws, 1.0);
#ifdef PROJECTIVE_MAP
  // Behind the light, where w < 0, this mirrors the map: see map_reaches().
  lookup_point.xyz /= lookup_point.w;
  own_point.xyz /= own_point.w;
#endif
  r.uv = lookup_point.xy;
  r.layer = 0;
  r.depth_per_texel = plane_depth_per_texel(normal_ws, r.n_dot_l);
  vec2 steepness = min(abs(r.depth_per_texel), vec2(bias_max_tangent * texel_size_ws / depth_range_ws));
  float flat_part = max(bias_constant, bias_slope * (1.0 - r.n_dot_l));
  precise float biased = lookup_point.z - (flat_part + bias_plane_texels * (steepness.x + steepness.y));
  r.depth = biased;
  r.depth_unbiased = own_point.z;
  r.texel_size_ws = texel_size_ws;
  r.depth_range_ws = depth_range_ws;
  r.light_size = light_size;
  r.view_depth = view_depth;
  r.pixel = pixel;
  return r;
}

// Whether the map says anything about a receiver; if not, the receiver is lit. The NO_ variants show what goes wrong
// without these tests: see filters/map_range.h.
bool map_reaches(Receiver r) {
#ifndef NO_FAR_TEST
  if (!(r.depth_unbiased <= 1.0)) return false;
#endif
#if defined(PROJECTIVE_MAP) && !defined(NO_BEHIND_TEST)
  if ((uv_depth_from_world * vec4(r.position_ws, 1.0)).w <= 0.0) return false;
#endif
  return true;
}
