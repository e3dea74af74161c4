/*+++
title = "Nine plain compared fetches"
source = "Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH"
kind = "comparison"
radius_texels = 1.5
[param.weight]
default = 1.0
min = 0.0
max = 1.0
text = "scales the result; there to have a parameter"
+++*/
float visibility(Receiver r) {
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) sum += r.depth <= fetch_depth(r, vec2(x, y)) ? 1.0 : 0.0;
  }
  return weight * sum / 9.0;
}
