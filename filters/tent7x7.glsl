/*+++
title = "Triangle of half-width 3.5 texels, in 16 hardware 2x2 fetches"
source = "Castano 2013, Shadow Mapping Summary, The Witness; fetches placed as in Sigg and Hadwiger 2005, GPU Gems 2, ch. 20; the triangle is integrated over each texel, as in Unity's Tent_7x7"
kind = "comparison"
radius_texels = 4
+++*/
const int pairs = 4;
#include "lib/texel_pairs.glsl"

float visibility(Receiver r) { return compare_pairs(r, triangle_weights(3.5, texel_fraction(r)), r.depth); }
