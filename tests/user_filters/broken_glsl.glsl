/*+++
title = "Has a mistake in its GLSL"
source = "a test"
kind = "other"
radius_texels = 0
+++*/
float visibility(Receiver r) {
  float lit = compare_nearest(r, vec2(0.0), r.depth);
  return lit * no_such_variable;
}
