// Turns the depth map into what the filter stores; of several samples a texel it stores the mean.
#include "lib/filter.glsl"

uniform int encode_border;  // 1: encode depth 1, which is what lies outside the map

layout(location = 0) out vec4 out_stored;

// One-sided differences meet silhouettes on one side only: the smaller one stays on the surface.
float smaller(float a, float b) { return abs(a) < abs(b) ? a : b; }

#ifdef SAMPLES
layout(binding = 4) uniform sampler2DMS depth_samples;
float depth_at(ivec2 texel, int i) { return linear_depth(texelFetch(depth_samples, texel, i).r); }
#else
#define SAMPLES 1
float depth_at(ivec2 texel, int i) { return linear_depth(texelFetch(map_depth, texel, 0).r); }
#endif

vec4 encode_sample(ivec2 texel, int i) {
  ivec2 last = textureSize(map_depth, 0) - 1;
  EncodeInput e;
  e.depth = 1.0;
  e.depth_per_texel = vec2(0.0);
  if (encode_border == 0) {
    e.depth = depth_at(texel, i);
    float left = depth_at(max(texel - ivec2(1, 0), ivec2(0)), i);
    float right = depth_at(min(texel + ivec2(1, 0), last), i);
    float below = depth_at(max(texel - ivec2(0, 1), ivec2(0)), i);
    float above = depth_at(min(texel + ivec2(0, 1), last), i);
    e.depth_per_texel = vec2(smaller(right - e.depth, e.depth - left), smaller(above - e.depth, e.depth - below));
  }
  return encode(e);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  out_stored = encode_sample(texel, 0);
#if SAMPLES > 1
#ifdef COMBINE_LOGS
  vec4 largest = out_stored;
  for (int i = 1; i < SAMPLES; ++i) largest = max(largest, encode_sample(texel, i));
  vec4 sum = vec4(0.0);
  for (int i = 0; i < SAMPLES; ++i) sum += exp(encode_sample(texel, i) - largest);
  out_stored = largest + log(sum / float(SAMPLES));
#else
  for (int i = 1; i < SAMPLES; ++i) out_stored += encode_sample(texel, i);
  out_stored /= float(SAMPLES);
#endif
#endif
}
