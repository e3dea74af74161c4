#include "lib/depth_curve.glsl"
// Writes the depth half-way between the first and the second surface that light meets.
layout(binding = 0) uniform sampler2D first_surface;
layout(binding = 1) uniform sampler2D second_surface;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float first = linear_depth(texelFetch(first_surface, texel, 0).r);
  float second = linear_depth(texelFetch(second_surface, texel, 0).r);
  gl_FragDepth = store_depth(0.5 * (first + second));
}
