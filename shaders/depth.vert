uniform mat4 clip_from_world;
layout(location = 0) in vec3 in_position_ws;
layout(location = 3) in vec2 in_uv;
out vec2 v_surface_uv;

void main() {
  v_surface_uv = in_uv;
  gl_Position = clip_from_world * vec4(in_position_ws, 1.0);
}
