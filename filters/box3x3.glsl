/*+++
title = "3x3 box of plain comparisons"
source = "Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH; teaching version: all nine texels around the receiver's instead of jittered samples, 1/9 each, so an edge has steps of 1/3"
kind = "comparison"
teaching = true
radius_texels = 1.5
+++*/
float visibility(Receiver r) {
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) sum += compare_nearest(r, vec2(x, y), r.depth);
  }
  return sum / 9.0;
}
