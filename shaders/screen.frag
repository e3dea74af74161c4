// One step of a filter's screen pass. PASS is the name of its function.
#include "lib/filter.glsl"

uniform int pass_step;

layout(location = 0) out vec2 out_screen;
#ifdef COUNT_FETCHES
layout(location = 1) out vec4 out_reads;  // their number, their reach in pixels, turns of a loop; -1: no receiver
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  out_screen = texelFetch(screen_image, pixel, 0).xy;
#ifdef COUNT_FETCHES
  out_reads = vec4(-1.0);
#endif
  if (out_screen.y < 0.0) return;
#ifdef COUNT_FETCHES
  for (int i = 0; i < LOOPS; ++i) turns_of[i] = 0;
#endif
  out_screen = PASS(ScreenInput(pixel, textureSize(screen_image, 0), pass_step));
  out_screen.y = max(out_screen.y, 0.0);
#ifdef COUNT_FETCHES
  out_reads = vec4(counted_screen_reads, counted_screen_reach, most_turns, 0.0);
#endif
}
