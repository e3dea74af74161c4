/*+++
title = "Reads an encoded map that nobody wrote"
source = "a test of what makes a filter suspect"
kind = "other"
radius_texels = 1
+++*/
float visibility(Receiver r) {
  float lit = compare_nearest(r, vec2(0.0), r.depth);
  return r.depth <= fetch_map(r, vec2(0.0)).x ? 1.0 : lit;
}
