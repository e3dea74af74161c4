#include "lib/depth_curve.glsl"

// How filters read the map. Offsets are in texels. Outside the map everything is lit, unless --border says otherwise.
layout(binding = 0) uniform sampler2D map_depth;                 // nearest
layout(binding = 1) uniform sampler2DShadow map_compare;         // hardware 2x2 PCF, LEQUAL (reversed: GEQUAL)
layout(binding = 2) uniform sampler2DShadow map_compare_nearest; // one texel, LEQUAL (reversed: GEQUAL)
layout(binding = 3) uniform sampler2D map_stored;                // what encode() wrote, prefiltered
uniform float map_texel_uv;                                      // 1 / map size

#ifdef COUNT_FETCHES
int fetch_count = 0;
vec2 wide_fetches = vec2(0.0);  // of fetch_count, those of texels of 64 and of 128 bits
float fetch_reach = 0.0;  // texels on either axis from the receiver to the centre of the farthest texel that was read
vec2 counted_uv;          // the receiver's own: a filter may move the uv of its copy

int turns_of[LOOPS];
int most_turns = 0;  // of a loop in one go; one that is left by break goes on counting when it begins again

bool count_turn(int loop, bool goes_on) {
  turns_of[loop] = goes_on ? turns_of[loop] + 1 : 0;
  most_turns = max(most_turns, turns_of[loop]);
  return goes_on;
}

void count_fetch(vec2 uv, vec2 offset_texels, float to_centre_texels, int texel_bits) {
  ++fetch_count;
  wide_fetches += vec2(texel_bits == 64, texel_bits == 128);
  vec2 offset = abs((uv - counted_uv) / map_texel_uv + offset_texels);
  fetch_reach = max(fetch_reach, max(offset.x, offset.y) + to_centre_texels);
}
#define COUNT_FETCH(r, offset_texels, to_centre_texels, texel_bits) \
  count_fetch(r.uv, offset_texels, to_centre_texels, texel_bits)
#define COUNT_GATHER(r, offset_texels) \
  count_fetch(r.uv, floor(r.uv / map_texel_uv + offset_texels - 0.5) + 1.0 - r.uv / map_texel_uv, 0.5, 32)
#define COUNT_LOAD(place_texels, to_centre_texels, texel_bits) \
  count_fetch(vec2(0.0), place_texels, to_centre_texels, texel_bits)
#else
#define COUNT_FETCH(r, offset_texels, to_centre_texels, texel_bits)
#define COUNT_GATHER(r, offset_texels)
#define COUNT_LOAD(place_texels, to_centre_texels, texel_bits)
#endif

#ifdef RECEIVER_PLANE
// The plane's depth at the texels that a fetch reads, instead of at the receiver; the same in filters/map_reader.h.
// A rasteriser snaps vertices to fractions of a texel, which tilts planes a little.
const float plane_slack_texels = 1.0 / 128.0;

float plane_depth(Receiver r, vec2 from_receiver_texels, float reach_texels, float z) {
  float steepest = bias_max_tangent * r.texel_size_ws / depth_range_ws;
  vec2 slope = clamp(r.depth_per_texel, vec2(-steepest), vec2(steepest));
  float lowest = (reach_texels + plane_slack_texels) * (abs(slope.x) + abs(slope.y));
  return min(z + dot(slope, from_receiver_texels) - lowest, 1.0);
}

float nearest_depth(Receiver r, vec2 offset_texels, float z) {
  vec2 own = r.uv / map_texel_uv;
  return plane_depth(r, floor(own + offset_texels) + 0.5 - own, 0.0, z);
}

// One depth for four texels: the plane's lowest among their centres, half a texel from the corner that they share.
float corner_depth(Receiver r, vec2 offset_texels, float z) {
  vec2 own = r.uv / map_texel_uv;
  return plane_depth(r, floor(own + offset_texels - 0.5) + 1.0 - own, 0.5, z);
}
#else
#define nearest_depth(r, offset_texels, z) (z)
#define corner_depth(r, offset_texels, z) (z)
#endif

// How far the receiver lies past the centre of the texel to its lower left, in texels, [0,1). An offset of whole texels
// less this is a texel's centre.
vec2 texel_fraction(Receiver r) { return fract(r.uv / map_texel_uv - 0.5); }

// Texels from a receiver to the next pixel's, of the two neighbours the nearer: the other one may lie beyond a silhouette.
vec2 step_to_neighbour(Receiver r, ivec2 way) {
  ivec2 last = textureSize(receiver_places, 0) - 1;
  vec2 nearer = vec2(0.0);
  float least = -1.0;
  for (int side = -1; side <= 1; side += 2) {
    ivec2 pixel = r.pixel + side * way;
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThan(pixel, last))) continue;
    vec4 place = texelFetch(receiver_places, pixel, 0);
    vec2 way_texels = (place.xy - r.uv) * float(side) / map_texel_uv;
    if (place.w == mark_background || (least >= 0.0 && length(way_texels) >= least)) continue;
    nearer = way_texels;
    least = length(way_texels);
  }
  return nearer;
}

// What fetch_NAME_grad takes: texels of the map that a step of one pixel crosses, along x and along y.
mat2 texels_per_pixel(Receiver r) {
  return mat2(step_to_neighbour(r, ivec2(1, 0)), step_to_neighbour(r, ivec2(0, 1)));
}

float compare_nearest(Receiver r, vec2 offset_texels, float z) {
  COUNT_FETCH(r, offset_texels, 0.5, 32);
  float reference = store_depth(nearest_depth(r, offset_texels, z));
  return texture(map_compare_nearest, vec3(r.uv + offset_texels * map_texel_uv, reference));
}

float compare_2x2(Receiver r, vec2 offset_texels, float z) {
  COUNT_FETCH(r, offset_texels, 1.0, 32);
  float reference = store_depth(corner_depth(r, offset_texels, z));
  return texture(map_compare, vec3(r.uv + offset_texels * map_texel_uv, reference));
}

float fetch_depth(Receiver r, vec2 offset_texels) {
  COUNT_FETCH(r, offset_texels, 0.5, 32);
  return linear_depth(texture(map_depth, r.uv + offset_texels * map_texel_uv).r);
}

// Four texels at once, those that compare_2x2 reads at the same offset: x upper left, y upper right, z lower right, w
// lower left. One fetch each.
vec4 gather_compare(Receiver r, vec2 offset_texels, float z) {
  COUNT_GATHER(r, offset_texels);
  float reference = store_depth(corner_depth(r, offset_texels, z));
  return textureGather(map_compare, r.uv + offset_texels * map_texel_uv, reference);
}

vec4 gather_depth(Receiver r, vec2 offset_texels) {
  COUNT_GATHER(r, offset_texels);
  vec4 stored = textureGather(map_depth, r.uv + offset_texels * map_texel_uv);
  return vec4(linear_depth(stored.x), linear_depth(stored.y), linear_depth(stored.z), linear_depth(stored.w));
}

vec4 fetch_map(Receiver r, vec2 offset_texels) {
  COUNT_FETCH(r, offset_texels, STORED_REACH_TEXELS, STORED_BITS);
  return texture(map_stored, r.uv + offset_texels * map_texel_uv);
}

// A texel of the depth map, linear in [0,1], and one of the encoded map; (0, 0) is the lower left, and outside the map
// its edge is repeated. For passes.
float load_depth(ivec2 texel) {
  COUNT_LOAD(vec2(texel) + 0.5, 0.0, 32);
  return linear_depth(texelFetch(map_depth, clamp(texel, ivec2(0), textureSize(map_depth, 0) - 1), 0).r);
}

vec4 load_map(ivec2 texel) {
  COUNT_LOAD(vec2(texel) + 0.5, STORED_REACH_TEXELS - 1.0, STORED_BITS);
  return texelFetch(map_stored, clamp(texel, ivec2(0), textureSize(map_stored, 0) - 1), 0);
}
