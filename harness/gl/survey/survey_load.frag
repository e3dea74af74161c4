// Arithmetic whose cost grows with u_iterations and that no compiler can shorten: each step needs the last.
uniform int u_iterations;
out float o_value;

void main() {
  float x = gl_FragCoord.x * 0.001 + gl_FragCoord.y * 0.0001;
  for (int i = 0; i < u_iterations; ++i) x = fract(x * 1.37 + 0.11);
  o_value = x;
}
