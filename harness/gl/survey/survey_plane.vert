// A plane over the viewport: depth u_depth at the lower left, rising by u_rise across the width and the height.
uniform float u_depth;
uniform vec2 u_rise;

void main() {
  vec2 uv = vec2(float((gl_VertexID & 1) << 1), float(gl_VertexID & 2));
  gl_Position = vec4(uv * 2.0 - 1.0, u_depth + dot(uv, u_rise), 1.0);
}
