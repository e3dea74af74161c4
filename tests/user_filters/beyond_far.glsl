/*+++
title = "A comparison outside the map, with a reference beyond the far plane"
source = "test"
kind = "other"
radius_texels = 0
+++*/
float visibility(Receiver r) { return compare_nearest(r, vec2(1e6), 1.5); }
