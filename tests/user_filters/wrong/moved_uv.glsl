/*+++
title = "Moves the uv of its copy of the receiver"
source = "a test of what makes a filter suspect"
kind = "other"
radius_texels = 1
+++*/
float visibility(Receiver r) {
  r.uv += 3.0 * map_texel_uv;
  return compare_2x2(r, vec2(0.0), r.depth);
}
