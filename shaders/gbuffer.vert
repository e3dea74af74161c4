uniform mat4 clip_from_world;
layout(location = 0) in vec3 in_position_ws;
layout(location = 1) in vec3 in_shading_normal_ws;
layout(location = 2) in vec3 in_face_normal_ws;
layout(location = 3) in vec2 in_uv;
layout(location = 4) in vec3 in_second_ws;  // of a triangle's last corner: the corner before it
layout(location = 5) in vec3 in_first_ws;   // and the one before that
out vec3 v_position_ws;
flat out mat3 v_corners_ws;                 // flat values are those of the last corner
out vec2 v_weights;                         // of the first corner and the second
out vec3 v_shading_normal_ws;
flat out vec3 v_face_normal_ws;
out vec2 v_surface_uv;

void main() {
  v_position_ws = in_position_ws;
  v_corners_ws = mat3(in_first_ws, in_second_ws, in_position_ws);
  v_weights = vec2(equal(ivec2(gl_VertexID % 3), ivec2(0, 1)));
  v_shading_normal_ws = in_shading_normal_ws;
  v_face_normal_ws = in_face_normal_ws;
  v_surface_uv = in_uv;
  gl_Position = clip_from_world * vec4(in_position_ws, 1.0);
}
