/*+++
title = "Four hardware 2x2 fetches, spread too far"
source = "Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH; teaching version of a mistake: fetches at +-1 texel weigh, per axis, (1-s)/2, s/2, (1-s)/2, s/2, two humps with a hole between, so an edge stays at 1/2 for a whole texel"
kind = "comparison"
teaching = true
radius_texels = 2
+++*/
float visibility(Receiver r) {
  float sum = compare_2x2(r, vec2(-1.0, -1.0), r.depth);
  sum += compare_2x2(r, vec2(1.0, -1.0), r.depth);
  sum += compare_2x2(r, vec2(-1.0, 1.0), r.depth);
  sum += compare_2x2(r, vec2(1.0, 1.0), r.depth);
  return 0.25 * sum;
}
