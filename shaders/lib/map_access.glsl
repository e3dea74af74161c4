// How filters read the map. Offsets are in texels. Outside the map everything is lit.
layout(binding = 0) uniform sampler2D map_depth;                 // nearest
layout(binding = 1) uniform sampler2DShadow map_compare;         // hardware 2x2 PCF, LEQUAL
layout(binding = 2) uniform sampler2DShadow map_compare_nearest; // one texel, LEQUAL
layout(binding = 3) uniform sampler2D map_stored;                // what encode() wrote, prefiltered
uniform float map_texel_uv;                                      // 1 / map size

#ifdef COUNT_FETCHES
int fetch_count = 0;
#define COUNT_ONE_FETCH ++fetch_count
#else
#define COUNT_ONE_FETCH
#endif

float compare_nearest(Receiver r, vec2 offset_texels, float z) {
  COUNT_ONE_FETCH;
  return texture(map_compare_nearest, vec3(r.uv + offset_texels * map_texel_uv, z));
}

float compare_2x2(Receiver r, vec2 offset_texels, float z) {
  COUNT_ONE_FETCH;
  return texture(map_compare, vec3(r.uv + offset_texels * map_texel_uv, z));
}

float fetch_depth(Receiver r, vec2 offset_texels) {
  COUNT_ONE_FETCH;
  return texture(map_depth, r.uv + offset_texels * map_texel_uv).r;
}

vec4 fetch_map(Receiver r, vec2 offset_texels) {
  COUNT_ONE_FETCH;
  return texture(map_stored, r.uv + offset_texels * map_texel_uv);
}
