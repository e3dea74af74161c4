#include "lib/gbuffer.glsl"
#include "lib/light.glsl"

// What a filter is told of a receiver point; filters/receiver.h documents the fields.
struct Receiver {
  vec3 position_ws;
  vec3 normal_ws;
  float n_dot_l;
  vec2 uv;
  int layer;
  float depth;
  float depth_unbiased;
  vec2 depth_per_texel;
  vec2 bias_per_texel;
  float texel_size_ws;
  float depth_range_ws;
  float light_size;
  float light_nearness;
  float view_depth;
  ivec2 pixel;
  uint frame;
};

uniform uint run_frame;  // of the frames that are accumulated; 0 where there is one

// What prepare_receivers.frag found out of every pixel, once per light. A filter pays only for what it reads: the
// compiler drops the rest.
layout(binding = 5) uniform sampler2D receiver_places;  // uv, depth before its bias, steepness; or a mark, in w
layout(binding = 6) uniform sampler2D receiver_planes;  // depth_per_texel, n_dot_l, view_depth
#ifdef LAYERED
layout(binding = 16) uniform sampler2D receiver_shares;  // of each receiver that this layer of the map serves, 0 .. 1
#endif

// Marks of pixels that no filter is asked about.
const float mark_background = -1.0;  // lit
const float mark_away = -2.0;        // dark: the surface shadows itself, there is nothing to filter
const float mark_beyond = -3.0;      // lit: the map says nothing about it

Receiver make_receiver(ivec2 pixel, vec4 place) {
  Receiver r;
  vec4 plane = texelFetch(receiver_planes, pixel, 0);
  r.position_ws = texelFetch(gbuffer_position, pixel, 0).xyz;
  r.normal_ws = texelFetch(gbuffer_normal, pixel, 0).xyz;
  r.n_dot_l = plane.z;
  r.uv = place.xy;
  r.layer = light_layer;
  r.depth_per_texel = plane.xy;
  r.texel_size_ws = texel_size_at(r.position_ws);
  r.bias_per_texel = bias_plane_kernels * min(abs(plane.xy), vec2(bias_max_tangent * r.texel_size_ws / depth_range_ws));
#ifdef BIAS_BY_SLOPE
  float flat_part = max(bias_constant, bias_slope * (1.0 - r.n_dot_l));
#else
  float flat_part = bias_constant;
#endif
  // `precise`: the pass that hands these values to the models must get the very same bits.
  precise float biased = place.z - (flat_part + bias_plane_texels * place.w);
  r.depth = biased;
  r.depth_unbiased = find_in_map(r.position_ws).z;
  r.depth_range_ws = depth_range_ws;
#ifdef PERSPECTIVE_LIGHT
  r.light_nearness = 1.0 / distance_along_light(r.position_ws);
  r.light_size = light_size * r.light_nearness;
#else
  r.light_nearness = 0.0;
  r.light_size = light_size;
#endif
  r.view_depth = plane.w;
  r.pixel = pixel;
  r.frame = run_frame;
  return r;
}
