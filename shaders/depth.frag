// Depth only; cut-out surfaces leave holes, and those that one sees through a pattern of them, if the run asks for one.
#include "lib/material.glsl"
#include "lib/depth_curve.glsl"
#include "lib/light.glsl"
#if defined(ALPHA_BLEND) && defined(STIPPLED_CASTERS)
#define STIPPLED
#include "lib/blend_casters.glsl"
#endif
#ifdef EXACT_EDGES
flat in mat3x4 corner_places;
flat in mat3x2 corner_uvs;
#else
in vec2 v_surface_uv;
#ifdef CURVED_MAP
in float v_depth;
#endif
#endif
#ifdef BEHIND_FIRST
layout(binding = 0) uniform sampler2D first_surface;
const float same_surface = 1e-6;  // two triangles that share an edge differ by rounding
#endif

#ifdef EXACT_EDGES
// (u w, w) are coordinates in which the triangle's edges are straight: a texel's centre lies inside it, or does not.
// Two triangles that share an edge both hold what lies on it.
vec3 find_weights() {
  vec2 uv = gl_FragCoord.xy / map_texels;
  float w = exp((uv.y - log_offset) / log_scale);
  vec2 place = vec2(uv.x * w, w);
  vec2 a = corner_places[0].xw - place, b = corner_places[1].xw - place, c = corner_places[2].xw - place;
  precise vec3 areas = vec3(b.x * c.y - c.x * b.y, c.x * a.y - a.x * c.y, a.x * b.y - b.x * a.y);
  if (any(lessThan(areas, vec3(0.0))) && any(greaterThan(areas, vec3(0.0)))) discard;
  float whole = areas.x + areas.y + areas.z;
  if (whole == 0.0) discard;
  return areas / whole;
}
#endif

// With BEND_DEPTH the projection gives linear depth, and the map stores that of a perspective. A reversed map is reversed
// by the projection.
float own_depth() {
#if defined(CURVED_MAP) && !defined(EXACT_EDGES)
  return v_depth;
#elif defined(BEND_DEPTH)
  return gl_FragCoord.z;
#else
  return linear_depth(gl_FragCoord.z);
#endif
}

void main() {
#ifdef STIPPLED
  float threshold = find_threshold();
#endif
#ifdef EXACT_EDGES
  vec3 weights = find_weights();
  vec2 surface_uv = corner_uvs * weights;
  float depth = (corner_places * weights).z;
#else
  vec2 surface_uv = v_surface_uv;
  float depth = own_depth();
#endif
#ifdef BEHIND_FIRST
  float behind = depth - linear_depth(texelFetch(first_surface, ivec2(gl_FragCoord.xy), 0).r);
  if (behind <= same_surface) discard;
#endif
#ifdef ALPHA_MASK
  surface_color(surface_uv);
#elif defined(STIPPLED)
  if (surface_color(surface_uv).a < threshold) discard;
#endif
#if defined(BEND_DEPTH) || defined(CURVED_MAP)
  gl_FragDepth = store_depth(depth);
#endif
}
