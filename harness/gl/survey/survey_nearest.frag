// Says which texel of u_map, whose values are their own indices, nearest sampling takes.
uniform sampler2D u_map;
uniform sampler2D u_coordinates;
out float o_value;

void main() {
  float u = texelFetch(u_coordinates, ivec2(gl_FragCoord.xy), 0).r;
  o_value = textureLod(u_map, vec2(u, 0.5), 0.0).r;
}
