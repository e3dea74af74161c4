// The shaders of this folder, each below a line with its name. They are compiled into the program.

//: fullscreen.vert
// One triangle that covers the viewport, made from the vertex index alone.
out vec2 v_uv;

void main() {
  v_uv = vec2(float((gl_VertexID & 1) << 1), float(gl_VertexID & 2));
  gl_Position = vec4(v_uv * 2.0 - 1.0, 0.0, 1.0);
}

//: survey_load.frag
// Arithmetic whose cost grows with u_iterations and that no compiler can shorten: each step needs the last.
uniform int u_iterations;
out float o_value;

void main() {
  float x = gl_FragCoord.x * 0.001 + gl_FragCoord.y * 0.0001;
  for (int i = 0; i < u_iterations; ++i) x = fract(x * 1.37 + 0.11);
  o_value = x;
}

//: survey_loop.frag
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

//: survey_filter.frag
// Samples between the two texels of a 2x1 map; the fraction u_first + column * u_step is exact in fp32.
uniform sampler2D u_map;
uniform float u_first;
uniform float u_step;
out float o_value;

void main() {
  float fraction = u_first + floor(gl_FragCoord.x) * u_step;
  o_value = textureLod(u_map, vec2(0.25 + 0.5 * fraction, 0.5), 0.0).r;
}

//: survey_exp.frag
// A function at arguments that the CPU knows exactly.
uniform sampler2D u_arguments;
out float o_value;

void main() { o_value = exp(texelFetch(u_arguments, ivec2(gl_FragCoord.xy), 0).x); }
