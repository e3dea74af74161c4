// Asks the filter for the visibility of every receiver; timed.
#include "lib/filter.glsl"

#ifdef SCREEN
layout(location = 0) out vec2 out_screen;  // as screen passes read it
#define out_visibility out_screen.x
#else
layout(location = 0) out float out_visibility;
#endif
#ifdef COUNT_FETCHES
layout(location = 1) out vec4 out_reads;  // fetches, their reach in texels, turns of a loop; -1: there was no lookup
layout(location = 2) out vec2 out_wide_reads;  // of the fetches those of texels of 64 and of 128 bits
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef LAYERED
  // The layers of a map add up what each makes of its share of a receiver.
  float share = texelFetch(receiver_shares, pixel, 0).x;
#else
  const float share = 1.0;
#endif
  vec4 place = texelFetch(receiver_places, pixel, 0);
  if (place.w < 0.0) {
    out_visibility = place.w == mark_away ? 0.0 : share;
#ifdef SCREEN
    out_screen.y = -1e30;
#endif
#ifdef COUNT_FETCHES
    out_reads = vec4(place.w == mark_beyond ? 0.0 : -1.0, -1.0, 0.0, 0.0);
    out_wide_reads = vec2(0.0);
#endif
    return;
  }
#ifdef COUNT_FETCHES
  counted_uv = place.xy;
  for (int i = 0; i < LOOPS; ++i) turns_of[i] = 0;
#endif
  out_visibility = share * visibility(make_receiver(pixel, place));
#ifdef SCREEN
  out_screen.y = share * max(screen_value, 0.0);
#endif
#ifdef COUNT_FETCHES
  out_reads = vec4(float(fetch_count), fetch_reach, float(most_turns), 0.0);
  out_wide_reads = wide_fetches;
#endif
}
