// What filters share whose kernel is as wide as the penumbra; filters/penumbra/penumbra_disk.h does the same.
#include "lib/disk.glsl"

const float one_fetch = 0.25;  // texels: a smaller disk is one fetch

// The disk's radius where the blocker is nearer by all of the depth range, texels.
float penumbra_per_depth(Receiver r) { return 0.5 * r.light_size * r.depth_range_ws / r.texel_size_ws; }

// The receiver's depth, biased for a tap by the tap's own distance.
float biased_depth(Receiver r, vec2 offset) { return r.depth - dot(r.bias_per_texel, abs(offset)); }
