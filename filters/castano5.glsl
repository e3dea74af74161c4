/*+++
title = "Weights 1, 3, 4, 3, 1, in nine hardware 2x2 fetches"
source = "Castano 2013, Shadow Mapping Summary, The Witness; fetches placed as in Sigg and Hadwiger 2005, GPU Gems 2, ch. 20"
kind = "comparison"
radius_texels = 3
+++*/
const int pairs = 3;
#include "lib/texel_pairs.glsl"

float visibility(Receiver r) {
  float at_texels[] = float[](1.0, 3.0, 4.0, 3.0, 1.0);
  return compare_pairs(r, sliding_weights(at_texels, texel_fraction(r)), r.depth);
}
