// Finds out where every pixel's surface lies in one light's map: all that does not depend on the filter. Never timed.
#include "lib/receiver.glsl"

layout(location = 0) out vec4 out_place;
layout(location = 1) out vec4 out_plane;
#ifdef LAYERED
layout(location = 2) out float out_share;  // of the receiver that this layer of the map serves; the background is layer 0's
#endif

// A surface faces the light where n.l is greater than this; filters/receiver.h has the same number.
const float faces_light = 1e-5;

// A plane may be steep, but not parallel to the light: its bias would have no bound.
vec2 plane_depth_per_texel(vec3 position_ws, vec3 normal_ws, float n_dot_l) {
#ifdef CURVED_MAP
  return plane_along_texels(position_ws, normal_ws);
#else
  vec2 along_map = vec2(dot(normal_ws, light_right_ws), dot(normal_ws, light_up_ws));
#ifdef PERSPECTIVE_LIGHT
  // A step of a texel slides along the receiver's own ray, which is as long as the axis is to there.
  n_dot_l = dot(normal_ws, light_position_ws - position_ws) / distance_along_light(position_ws);
#endif
  vec2 tangent = along_map / max(n_dot_l, 1e-4);
  return tangent * (texel_size_at(position_ws) / depth_range_ws);
#endif
}

// Whether the map says anything about a receiver. The NO_ variants show what goes wrong without these tests: see
// filters/depth_map.h.
bool map_reaches(float depth_unbiased, float w) {
#ifndef NO_FAR_TEST
  if (!(depth_unbiased <= 1.0)) return false;
#endif
#if defined(PROJECTIVE_MAP) && !defined(NO_BEHIND_TEST)
  if (w <= 0.0) return false;
#endif
  return true;
}

#ifdef VIEW_SLICE
uniform vec4 layer_slice;  // view depths: fade in from, to; fade out from, to

float ramp(float view_depth, float from, float to) {
  return from < to ? clamp((view_depth - from) / (to - from), 0.0, 1.0) : float(view_depth >= from);
}

float find_share(vec4 position) {
  return ramp(position.w, layer_slice.x, layer_slice.y) - ramp(position.w, layer_slice.z, layer_slice.w);
}
#endif

#ifdef HALF_SPHERE
float find_share(vec4 position) {
  float ahead = dot(position.xyz - light_position_ws, light_direction_ws);
  return float(light_layer == 0 ? ahead >= 0.0 : ahead > 0.0);
}
#endif

#ifdef CUBE_FACE
uniform int layer_face;  // +x, -x, +y, -y, +z, -z

float find_share(vec4 position) {
  vec3 way = position.xyz - light_position_ws, length_along = abs(way);
  int axis = length_along.x >= max(length_along.y, length_along.z) ? 0 : length_along.y >= length_along.z ? 1 : 2;
  return float(2 * axis + int(way[axis] < 0.0) == layer_face);
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  out_place = vec4(0.0, 0.0, 0.0, mark_background);
  out_plane = vec4(0.0);
#ifdef LAYERED
  out_share = position.w == 0.0 ? float(light_layer == 0) : find_share(position);
  gl_FragDepth = out_share > 0.0 ? 0.0 : 1.0;  // a depth test leaves the rest out before it is shaded
#endif
  if (position.w == 0.0) return;
  vec3 normal = texelFetch(gbuffer_normal, pixel, 0).xyz;
  float n_dot_l = dot(normal, direction_to_light(position.xyz));
  float sin_theta = sqrt(max(1.0 - n_dot_l * n_dot_l, 0.0));
  precise vec3 offset_ws = position.xyz + normal * (bias_normal_texels * texel_size_at(position.xyz) * sin_theta);
  vec4 lookup_point = find_in_map(offset_ws);
  vec4 own_point = find_in_map(position.xyz);
  vec2 depth_per_texel = plane_depth_per_texel(position.xyz, normal, n_dot_l);
  vec2 steepness = min(abs(depth_per_texel), vec2(bias_max_tangent * texel_size_at(position.xyz) / depth_range_ws));
  out_plane = vec4(depth_per_texel, n_dot_l, position.w);
  out_place = vec4(lookup_point.xyz, steepness.x + steepness.y);
  if (!map_reaches(own_point.z, own_point.w)) out_place.w = mark_beyond;
  if (n_dot_l <= faces_light) out_place.w = mark_away;
#ifdef PERSPECTIVE_LIGHT
  if (light_cone_at(position.xyz) <= 0.0) out_place.w = mark_away;
#endif
}
