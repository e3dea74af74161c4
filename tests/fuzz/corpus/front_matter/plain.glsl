/*+++
title = "t"
source = "s"
kind = "comparison"
radius_texels = 1.5
claims = []
+++*/
float visibility(Receiver r) { return compare_2x2(r, vec2(0), r.depth); }
