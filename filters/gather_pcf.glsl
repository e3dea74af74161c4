/*+++
title = "PCF with a kernel of your choice, through gathers"
source = "Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH; kernels of Castano 2013, Shadow Mapping Summary, The Witness"
kind = "comparison"
radius_texels = "radius"
[param.radius]
default = 2
choices = [1, 2, 3]
const = true
unit = "texels"
text = "how far gathers lie off the receiver, so that 4, 9 or 16 of them read 4x4, 6x6 or 8x8 texels; wider is softer"
[param.shape]
default = "triangle"
choices = ["triangle", "castano"]
text = "triangle weighs as tent4x4, tent5x5 and tent7x7 do, castano as castano3, castano5 and castano7, a little wider at the first radii and narrower at the last"
+++*/
const int pairs = radius + 1;
#include "lib/texel_pairs.glsl"

const float castano[] = float[](1.0, 2.0, 1.0,                          // of radius 1
                                1.0, 3.0, 4.0, 3.0, 1.0,                // of radius 2
                                1.0, 5.0, 12.0, 16.0, 12.0, 5.0, 1.0);  // of radius 3

float visibility(Receiver r) {
  vec2 t = texel_fraction(r);
  if (shape == SHAPE_TRIANGLE) return gather_pairs(r, triangle_weights(float(pairs) - 0.5, t), r.depth);
  return gather_pairs(r, sliding_weights(castano, radius * radius - 1, t), r.depth);
}
