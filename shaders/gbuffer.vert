uniform mat4 clip_from_world;
layout(location = 0) in vec3 in_position_ws;
layout(location = 1) in vec3 in_shading_normal_ws;
layout(location = 2) in vec3 in_face_normal_ws;
layout(location = 3) in vec2 in_uv;
out vec3 v_position_ws;
out vec3 v_shading_normal_ws;
flat out vec3 v_face_normal_ws;
out vec2 v_surface_uv;

void main() {
  v_position_ws = in_position_ws;
  v_shading_normal_ws = in_shading_normal_ws;
  v_face_normal_ws = in_face_normal_ws;
  v_surface_uv = in_uv;
  gl_Position = clip_from_world * vec4(in_position_ws, 1.0);
}
