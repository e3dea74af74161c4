// What filters share whose kernel is as wide as the penumbra; filters/penumbra.h does the same.
#include "lib/disk.glsl"
#include "lib/penumbra_radius.glsl"

const float one_fetch = 0.25;  // texels: a smaller disk is one fetch

// The receiver's depth, biased for a tap by the tap's own distance.
float biased_depth(Receiver r, vec2 offset) { return r.depth - dot(r.bias_per_texel, abs(offset)); }

// The four texels that compare_2x2 reads at an offset, and how it weighs them.
struct Corner {
  vec2 offset;   // for a gather: half-way between texels, so that rounding cannot take others
  vec4 weights;  // in the order of a gather
};

Corner find_corner(Receiver r, vec2 offset) {
  vec2 place = texel_fraction(r);
  vec2 texel = floor(place + offset);
  vec2 t = place + offset - texel;
  return Corner(texel + 0.5 - place,
                vec4((1.0 - t.x) * t.y, t.x * t.y, t.x * (1.0 - t.y), (1.0 - t.x) * (1.0 - t.y)));
}
