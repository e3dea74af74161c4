// Asks the filter for the visibility of every receiver; timed.
#include "lib/receiver.glsl"
#include "lib/gbuffer.glsl"
#include "lib/map_access.glsl"
#include "lib/random.glsl"
#include "lib/encode_input.glsl"
#include "filter_parameters"
#include "filter"

layout(location = 0) out float out_visibility;
#ifdef COUNT_FETCHES
layout(location = 1) out vec2 out_reads;  // number of fetches, and their reach in texels; -1: there was no lookup
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  out_visibility = 1.0;
#ifdef COUNT_FETCHES
  out_reads = vec2(-1.0);
#endif
  if (position.w == 0.0) return;
  Receiver r = make_receiver(position.xyz, texelFetch(gbuffer_normal, pixel, 0).xyz, position.w, pixel);
  if (r.n_dot_l <= faces_light) {
    out_visibility = 0.0;  // the surface shadows itself: there is nothing to filter
    return;
  }
#ifdef COUNT_FETCHES
  counted_uv = r.uv;
  out_reads.x = 0.0;
#endif
  if (!map_reaches(r)) return;
  out_visibility = visibility(r);
#ifdef COUNT_FETCHES
  out_reads = vec2(float(fetch_count), fetch_reach);
#endif
}
