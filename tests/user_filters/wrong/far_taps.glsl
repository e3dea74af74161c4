/*+++
title = "Four 2x2 fetches that reach farther than declared"
source = "a test of what makes a filter suspect"
kind = "other"
radius_texels = 1.5
+++*/
float visibility(Receiver r) {
  float sum = compare_2x2(r, vec2(-1.5, -0.5), r.depth) + compare_2x2(r, vec2(1.5, -0.5), r.depth);
  return 0.25 * (sum + compare_2x2(r, vec2(-1.5, 0.5), r.depth) + compare_2x2(r, vec2(1.5, 0.5), r.depth));
}
