// Along v a logarithmic map bends the edges of triangles: each is drawn as the box around it, and the fragment shader
// leaves out what lies beyond its edges.
#include "lib/light.glsl"
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
in vec2 v_surface_uv[];
in vec4 v_map_place[];
flat out mat3x4 corner_places;
flat out mat3x2 corner_uvs;

float find_w(float v) { return exp((v - log_offset) / log_scale); }

void main() {
  float first = find_w(0.0), last = find_w(1.0), nearest = min(first, last), farthest = max(first, last);
  vec2 low = vec2(1e30), high = vec2(-1e30);  // u, w
  for (int i = 0; i < 3; ++i) {
    vec2 a = v_map_place[i].xw, b = v_map_place[(i + 1) % 3].xw;
    for (int side = 0; side < 3; ++side) {  // the corner, and where its edge enters and leaves the map
      float w = side == 0 ? a.y : side == 1 ? nearest : farthest;
      float t = side == 0 ? 0.0 : (w - a.y) / (b.y - a.y);
      if (!(t >= 0.0 && t <= 1.0) || w < nearest || w > farthest) continue;
      vec2 place = vec2(mix(a.x, b.x, t) / w, w);
      low = min(low, place);
      high = max(high, place);
    }
  }
  if (low.x > high.x) return;
  vec2 ends = log_scale * log(vec2(low.y, high.y)) + log_offset;
  const float slack = 1e-5;
  low = max(vec2(low.x, min(ends.x, ends.y)) - slack, vec2(0.0));
  high = min(vec2(high.x, max(ends.x, ends.y)) + slack, vec2(1.0));
  if (any(greaterThanEqual(low, high))) return;
  vec2 a = v_map_place[1].xw - v_map_place[0].xw, b = v_map_place[2].xw - v_map_place[0].xw;
  bool turned = (a.x * b.y - a.y * b.x < 0.0) != (log_scale < 0.0);  // the box faces as the triangle does
  for (int corner = 0; corner < 4; ++corner) {
    vec2 uv = vec2((corner & 1) != int(turned) ? high.x : low.x, corner < 2 ? low.y : high.y);
    gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
    corner_places = mat3x4(v_map_place[0], v_map_place[1], v_map_place[2]);
    corner_uvs = mat3x2(v_surface_uv[0], v_surface_uv[1], v_surface_uv[2]);
    EmitVertex();
  }
  EndPrimitive();
}
