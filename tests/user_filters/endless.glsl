/*+++
title = "Never returns"
source = "a test"
kind = "other"
radius_texels = 0
+++*/
float visibility(Receiver r) {
  float x = r.depth;
  for (int i = 0; i < 2000000000; ++i) {
    for (int j = 0; j < 2000000000; ++j) x = fract(x * 1.37 + fetch_depth(r, vec2(x)));
  }
  return x;
}
