// Depth only; cut-out surfaces leave holes.
#include "lib/material.glsl"
#include "lib/depth_curve.glsl"
in vec2 v_surface_uv;
#ifdef BEHIND_FIRST
layout(binding = 0) uniform sampler2D first_surface;
const float same_surface = 1e-6;  // two triangles that share an edge differ by rounding
#endif

// With BEND_DEPTH the projection gives linear depth, and the map stores that of a perspective. A reversed map is reversed
// by the projection.
float own_depth() {
#ifdef BEND_DEPTH
  return gl_FragCoord.z;
#else
  return linear_depth(gl_FragCoord.z);
#endif
}

void main() {
#ifdef BEHIND_FIRST
  float behind = own_depth() - linear_depth(texelFetch(first_surface, ivec2(gl_FragCoord.xy), 0).r);
  if (behind <= same_surface) discard;
#endif
#ifdef ALPHA_MASK
  surface_color(v_surface_uv);
#endif
#ifdef BEND_DEPTH
  gl_FragDepth = store_depth(own_depth());
#endif
}
