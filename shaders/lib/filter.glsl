// A filter, and what its GLSL is given in every pass.
#include "lib/receiver.glsl"
#include "lib/map_access.glsl"
#include "lib/random.glsl"

// What encode() is told of a texel of the depth map.
struct EncodeInput {
  float depth;            // [0,1]
  vec2 depth_per_texel;   // of the stored surface, the smaller of the two one-sided differences per axis
};

// What a pass of a filter's own is told.
struct PassInput {
  ivec2 texel;      // of the map that it writes
  ivec2 size;       // of that map, at this level
  int step;         // 0, 1, 2, ... of its steps
  ivec2 direction;  // axes and prefix sums, from step 1 on: (1, 0), and then (0, 1)
  int stride;       // prefix sums: 1, 4, 16, ... from step 1 on
};

#include "lib/screen_input.glsl"
#include "filter_parameters"
#include "filter"
