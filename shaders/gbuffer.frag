// Draws what the camera sees, once per view: filters and truth share these receiver points.
#include "lib/material.glsl"
uniform vec3 camera_position_ws;
uniform vec3 camera_forward_ws;
uniform int orthographic;

in vec3 v_position_ws;
in vec3 v_shading_normal_ws;
flat in vec3 v_face_normal_ws;
in vec2 v_surface_uv;

layout(location = 0) out vec4 out_position;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_shading_normal;
layout(location = 3) out vec4 out_albedo;

void main() {
  vec4 color = surface_color(v_surface_uv);
  vec3 from_camera = v_position_ws - camera_position_ws;
  vec3 view_ray = orthographic == 1 ? camera_forward_ws : from_camera;
  // Both sides of a surface are seen and lit; the normals follow the side that is seen.
  float side = dot(v_face_normal_ws, view_ray) > 0.0 ? -1.0 : 1.0;
  vec3 face_normal = side * v_face_normal_ws;
  vec3 shading_normal = normalize(v_shading_normal_ws);
  if (dot(shading_normal, face_normal) < 0.0) shading_normal = -shading_normal;
  out_position = vec4(v_position_ws, max(dot(from_camera, camera_forward_ws), 1e-30));
  out_normal = vec4(face_normal, 0.0);
  out_shading_normal = vec4(shading_normal, 0.0);
  out_albedo = vec4(color.rgb, 1.0);
}
