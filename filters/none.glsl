/*+++
title = "No filter"
source = "Williams 1978, Casting Curved Shadows on Curved Surfaces, SIGGRAPH"
kind = "comparison"
radius_texels = 0
+++*/
float visibility(Receiver r) { return compare_nearest(r, vec2(0.0), r.depth); }
