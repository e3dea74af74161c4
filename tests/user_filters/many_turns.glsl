/*+++
title = "Takes 200 000 turns where it matters"
source = "a test"
kind = "other"
radius_texels = 0
+++*/
float visibility(Receiver r) {
  float lit = compare_nearest(r, vec2(0.0), r.depth);
  int turns = r.pixel.x == 80 && r.pixel.y < 40 ? 200000 : 1;
  float x = 0.3;
  for (int i = 0; i < turns; ++i) x = fract(x * 1.37 + 0.11);  // while (false);
  return lit * min(x + 1.0, 1.0);
}
