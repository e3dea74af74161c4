/*+++
title = "Triangle of half-width 1.5 texels, in four hardware 2x2 fetches"
source = "Castano 2013, Shadow Mapping Summary, The Witness; fetches placed as in Sigg and Hadwiger 2005, GPU Gems 2, ch. 20; the triangle is integrated over each texel, as in Unity's Tent_3x3"
kind = "comparison"
radius_texels = 2
+++*/
const int pairs = 2;
#include "lib/texel_pairs.glsl"

float visibility(Receiver r) { return compare_pairs(r, triangle_weights(1.5, texel_fraction(r)), r.depth); }
