/*+++
title = "Divides by 0 where it should be dark"
source = "a test of what makes a filter suspect"
kind = "other"
radius_texels = 1
+++*/
float visibility(Receiver r) {
  float lit = compare_2x2(r, vec2(0.0), r.depth);
  return lit > 0.0 ? lit : lit / lit;
}
