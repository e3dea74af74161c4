// Draws what the camera sees, once per view: filters and truth share these receiver points.
#include "lib/material.glsl"
uniform vec3 camera_position_ws;
uniform vec3 camera_forward_ws;
uniform int orthographic;

in vec3 v_position_ws;
flat in mat3 v_corners_ws;
in vec2 v_weights;
in vec3 v_shading_normal_ws;
flat in vec3 v_face_normal_ws;
in vec2 v_surface_uv;

layout(location = 0) out vec4 out_position;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_shading_normal;
layout(location = 3) out vec4 out_albedo;

// The point of the triangle that this pixel shows. No standard says how far from it an interpolated position may lie:
// the error grows with the triangle's slope across the picture. Where an edge was moved to the grid of subpixels, the
// position may also lie beyond that edge: in a valley, below the next surface.
// A position that is off the plane by more than 8 roundings of the largest coordinate is therefore made of the corners.
// So is one that is nearer to an edge than a margin: the roundings of a point, and of a ray past the triangle beyond.
// Only a back face keeps its position there: that of a solid is seen only between edges that were moved apart, and lies
// outside.
vec3 find_position() {
  const float rounding = exp2(-24.0);
  vec3 first = v_corners_ws[0] - v_corners_ws[2], second = v_corners_ws[1] - v_corners_ws[2];
  vec3 edges = vec3(length(second), length(first), length(first - second));  // each opposite its corner
  vec3 far = max(abs(v_corners_ws[0]), max(abs(v_corners_ws[1]), abs(v_corners_ws[2])));
  float largest = max(far.x, max(far.y, far.z)), longest = max(max(edges.x, max(edges.y, edges.z)), 1e-18);
  float margin = rounding * (2.0 * largest / longest + 16.0);  // in longest edges, whose squares may be too small
  float twice_area = max(length(cross(first / longest, second / longest)), 1e-30);
  vec3 least = min(margin * (edges / longest) / twice_area, 1.0 / 3.0);
  vec3 above = max(vec3(v_weights, 1.0 - v_weights.x - v_weights.y) - least, 0.0);
  vec3 weights = least + above * (1.0 - dot(least, vec3(1.0))) / max(dot(above, vec3(1.0)), 1e-30);
  precise vec3 position = v_corners_ws[2] + (weights.x * first + weights.y * second);
  float height = dot(v_face_normal_ws, v_position_ws - position);
  bool is_inside = !gl_FrontFacing || all(greaterThan(above, vec3(0.0)));
  return is_inside && abs(height) <= 8.0 * rounding * largest ? v_position_ws : position;
}

void main() {
  vec4 color = surface_color(v_surface_uv);
  vec3 position = find_position();
  vec3 from_camera = position - camera_position_ws;
  vec3 view_ray = orthographic == 1 ? camera_forward_ws : from_camera;
  // Both sides of a surface are seen and lit; the normals follow the side that is seen.
  float side = dot(v_face_normal_ws, view_ray) > 0.0 ? -1.0 : 1.0;
  vec3 face_normal = side * v_face_normal_ws;
  vec3 shading_normal = normalize(v_shading_normal_ws);
  if (dot(shading_normal, face_normal) < 0.0) shading_normal = -shading_normal;
  out_position = vec4(position, max(dot(from_camera, camera_forward_ws), 1e-30));
  out_normal = vec4(face_normal, 0.0);
  out_shading_normal = vec4(shading_normal, 0.0);
  out_albedo = vec4(color.rgb, 1.0);
}
