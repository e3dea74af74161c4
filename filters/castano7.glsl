/*+++
title = "Weights 1, 5, 12, 16, 12, 5, 1, in 16 hardware 2x2 fetches"
source = "Castano 2013, Shadow Mapping Summary, The Witness; fetches placed as in Sigg and Hadwiger 2005, GPU Gems 2, ch. 20"
kind = "comparison"
radius_texels = 4
+++*/
const int pairs = 4;
#include "lib/texel_pairs.glsl"

float visibility(Receiver r) {
  float at_texels[] = float[](1.0, 5.0, 12.0, 16.0, 12.0, 5.0, 1.0);
  return compare_pairs(r, sliding_weights(at_texels, texel_fraction(r)), r.depth);
}
