// The light, its map, and the run's bias; the same uniforms in every pass that asks where a point lies in the map.
uniform mat4 uv_depth_from_world;
uniform vec3 light_direction_ws;   // the way the light travels
uniform vec3 light_right_ws;       // world direction of +u
uniform vec3 light_up_ws;          // world direction of +v
uniform float texel_size_ws;
uniform float depth_range_ws;
uniform float light_size;
uniform float bias_constant;       // depth; the larger of this and the next holds
uniform float bias_slope;          // depth, times 1 - n.l
uniform float bias_plane_texels;
uniform float bias_plane_kernels;   // the share of that per texel of a filter's reach
uniform float bias_normal_texels;
uniform float bias_max_tangent;    // steeper planes are treated as this steep
uniform int light_layer;           // of the map: a cascade, a face of a cube; 0 where there is one
#ifdef LOG_MAP
uniform float log_scale;           // v is this times the logarithm of w, plus the next
uniform float log_offset;
#endif

#ifdef PERSPECTIVE_LIGHT
// A light that stands in the scene, with a map drawn through a perspective. light_size is its diameter in metres.
uniform vec3 light_position_ws;
uniform vec2 light_cone;          // cosines to the axis: full strength within the first, none beyond the second
uniform float light_reference_m;  // where a texel has texel_size_ws, and the light its strength

vec3 direction_to_light(vec3 position_ws) { return normalize(light_position_ws - position_ws); }

#ifdef PARABOLOID_MAP
float distance_along_light(vec3 position_ws) { return length(position_ws - light_position_ws); }
#else
float distance_along_light(vec3 position_ws) { return dot(position_ws - light_position_ws, light_direction_ws); }

float texel_size_at(vec3 position_ws) {
  return texel_size_ws * (distance_along_light(position_ws) / light_reference_m);
}
#endif

// As scene::Beam::cone_at() computes it. NO_BEHIND_TEST shows what a projection makes of what is behind the light: it
// mirrors the cone.
float light_cone_at(vec3 position_ws) {
  float cosine = dot(-direction_to_light(position_ws), light_direction_ws);
#ifdef NO_BEHIND_TEST
  cosine = abs(cosine);
#endif
  float ramp = clamp((cosine - light_cone.y) / max(light_cone.x - light_cone.y, 1e-4), 0.0, 1.0);
  return ramp * ramp;
}

float light_strength(vec3 position_ws) {
  vec3 way = (position_ws - light_position_ws) / light_reference_m;
  return light_cone_at(position_ws) / max(dot(way, way), 1e-4);
}
#else
// The direction from a point to the light's centre, unit length.
vec3 direction_to_light(vec3 position_ws) { return -light_direction_ws; }

#ifndef WARPED_MAP
float texel_size_at(vec3 position_ws) { return texel_size_ws; }
#endif

// Of what arrives where nothing is in the way.
float light_strength(vec3 position_ws) { return 1.0; }
#endif

#include "lib/map_shape.glsl"
