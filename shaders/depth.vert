#include "lib/light.glsl"
uniform mat4 clip_from_world;
layout(location = 0) in vec3 in_position_ws;
layout(location = 3) in vec2 in_uv;
out vec2 v_surface_uv;
#ifdef HASHED_CASTERS
out vec3 v_position_ws;
#endif
#ifdef EXACT_EDGES
out vec4 v_map_place;  // u w, -, depth, w
#elif defined(CURVED_MAP)
out float v_depth;
#endif

void main() {
  v_surface_uv = in_uv;
#ifdef HASHED_CASTERS
  v_position_ws = in_position_ws;
#endif
#ifdef EXACT_EDGES
  v_map_place = uv_depth_from_world * vec4(in_position_ws, 1.0);
#elif defined(PARABOLOID_MAP)
  // Edges stay straight between their ends, which is the paraboloid's error; what is well behind is cut off.
  vec4 place = find_in_map(in_position_ws);
  v_depth = place.z;
  gl_ClipDistance[0] = place.w - 0.5;
  gl_Position = vec4(2.0 * (place.w > 0.01 ? place.xy : vec2(0.5)) - 1.0, 0.0, 1.0);
#else
  gl_Position = clip_from_world * vec4(in_position_ws, 1.0);
#ifdef CURVED_MAP
  v_depth = (uv_depth_from_world * vec4(in_position_ws, 1.0)).z;
#endif
#endif
}
