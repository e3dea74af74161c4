// Depth only; cut-out surfaces leave holes.
#include "lib/material.glsl"
in vec2 v_surface_uv;
#ifdef BEHIND_FIRST
layout(binding = 0) uniform sampler2D first_surface;
const float same_surface = 1e-6;  // two triangles that share an edge differ by rounding
#endif

void main() {
#ifdef BEHIND_FIRST
  float behind = gl_FragCoord.z - texelFetch(first_surface, ivec2(gl_FragCoord.xy), 0).r;
#ifdef REVERSED_DEPTH
  behind = -behind;
#endif
  if (behind <= same_surface) discard;
#endif
#ifdef ALPHA_MASK
  surface_color(v_surface_uv);
#endif
}
