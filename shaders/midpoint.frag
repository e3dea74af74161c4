// Writes the depth half-way between the first and the second surface that light meets.
layout(binding = 0) uniform sampler2D first_surface;
layout(binding = 1) uniform sampler2D second_surface;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  gl_FragDepth = 0.5 * (texelFetch(first_surface, texel, 0).r + texelFetch(second_surface, texel, 0).r);
}
