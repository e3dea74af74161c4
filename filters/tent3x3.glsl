/*+++
title = "3x3 tent in four hardware 2x2 fetches"
source = "Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH; box(2) convolved with box(1), per axis (1-s)/2, 1/2, s/2"
kind = "comparison"
radius_texels = 1.5
+++*/
float visibility(Receiver r) {
  float sum = compare_2x2(r, vec2(-0.5, -0.5), r.depth);
  sum += compare_2x2(r, vec2(0.5, -0.5), r.depth);
  sum += compare_2x2(r, vec2(-0.5, 0.5), r.depth);
  sum += compare_2x2(r, vec2(0.5, 0.5), r.depth);
  return 0.25 * sum;
}
