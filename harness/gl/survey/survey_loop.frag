// A loop whose number of turns the compiler cannot foresee.
uniform int u_turns;
out float o_turns;

void main() {
  int turns = 0;
  float x = 0.37;
  for (int i = 0; i < u_turns; ++i) {
    x = fract(x * 1.37 + 0.11);
    turns += x < 2.0 ? 1 : 0;
  }
  o_turns = float(turns);
}
