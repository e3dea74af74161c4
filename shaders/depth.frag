// Depth only; cut-out surfaces leave holes.
#include "lib/material.glsl"
in vec2 v_surface_uv;

void main() {
#ifdef ALPHA_MASK
  surface_color(v_surface_uv);
#endif
}
