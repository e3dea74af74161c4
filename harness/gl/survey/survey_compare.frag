// Compares between the two texels of a 2x1 map; the fraction u_first + column * u_step is exact in fp32.
uniform sampler2DShadow u_map;
uniform float u_first;
uniform float u_step;
uniform float u_reference;
out float o_value;

void main() {
  float fraction = u_first + floor(gl_FragCoord.x) * u_step;
  o_value = textureLod(u_map, vec3(0.25 + 0.5 * fraction, 0.5, u_reference), 0.0);
}
