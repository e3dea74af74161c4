// Writes the receivers that the lookup pass sees, for the models; never timed.
#include "lib/receiver.glsl"

layout(location = 0) out vec4 out_map;    // uv, depth, depth_unbiased
layout(location = 2) out vec4 out_light;  // texel_size_ws, light_size, light_nearness, the layer's share
layout(location = 1) out vec4 out_plane;  // depth_per_texel, n_dot_l, view_depth (0: no receiver, negative: beyond the map's reach)

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = texelFetch(receiver_places, pixel, 0);
  out_map = vec4(0.0);
  out_plane = vec4(0.0);
  out_light = vec4(0.0);
  if (place.w == mark_background || place.w == mark_away) return;
  Receiver r = make_receiver(pixel, place);
  out_map = vec4(r.uv, r.depth, r.depth_unbiased);
  out_light = vec4(r.texel_size_ws, r.light_size, r.light_nearness, 1.0);
#ifdef LAYERED
  out_light.w = texelFetch(receiver_shares, pixel, 0).x;
#endif
  out_plane = vec4(r.depth_per_texel, r.n_dot_l, place.w == mark_beyond ? -r.view_depth : r.view_depth);
}
