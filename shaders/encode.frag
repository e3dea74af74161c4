// Turns the depth map into what the filter stores.
#include "lib/receiver.glsl"
#include "lib/map_access.glsl"
#include "lib/random.glsl"
#include "lib/encode_input.glsl"
#include "lib/pass_input.glsl"
#include "filter_parameters"
#include "filter"

uniform int encode_border;  // 1: encode depth 1, which is what lies outside the map

layout(location = 0) out vec4 out_stored;

// One-sided differences meet silhouettes on one side only: the smaller one stays on the surface.
float smaller(float a, float b) { return abs(a) < abs(b) ? a : b; }

float depth_at(ivec2 texel) { return linear_depth(texelFetch(map_depth, texel, 0).r); }

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(map_depth, 0) - 1;
  EncodeInput e;
  e.depth = 1.0;
  e.depth_per_texel = vec2(0.0);
  if (encode_border == 0) {
    e.depth = depth_at(texel);
    float left = depth_at(max(texel - ivec2(1, 0), ivec2(0)));
    float right = depth_at(min(texel + ivec2(1, 0), last));
    float below = depth_at(max(texel - ivec2(0, 1), ivec2(0)));
    float above = depth_at(min(texel + ivec2(0, 1), last));
    e.depth_per_texel = vec2(smaller(right - e.depth, e.depth - left), smaller(above - e.depth, e.depth - below));
  }
  out_stored = encode(e);
}
