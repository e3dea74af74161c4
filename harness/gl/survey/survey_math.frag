// Functions at arguments that the CPU knows exactly.
uniform sampler2D u_arguments;
out vec4 o_values;

void main() {
  vec2 argument = texelFetch(u_arguments, ivec2(gl_FragCoord.xy), 0).xy;
  o_values = vec4(exp(argument.x), sin(argument.y), cos(argument.y), 0.0);
}
