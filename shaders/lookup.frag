// Asks the filter for the visibility of every receiver; timed.
#include "lib/receiver.glsl"
#include "lib/map_access.glsl"
#include "lib/random.glsl"
#include "lib/encode_input.glsl"
#include "filter_parameters"
#include "filter"

layout(location = 0) out float out_visibility;
#ifdef COUNT_FETCHES
layout(location = 1) out float out_fetches;
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = texelFetch(receiver_places, pixel, 0);
  if (place.w < 0.0) {
    out_visibility = place.w == mark_away ? 0.0 : 1.0;
#ifdef COUNT_FETCHES
    out_fetches = place.w == mark_beyond ? 0.0 : -1.0;  // below 0: not a receiver
#endif
    return;
  }
  out_visibility = visibility(make_receiver(pixel, place));
#ifdef COUNT_FETCHES
  out_fetches = float(fetch_count);
#endif
}
