/*+++
title = "Hard shadow of a map in fixed point"
source = "OpenGL 4.5, section 8.23.1: the reference is clamped to [0,1] where the map is in fixed point"
kind = "comparison"
radius_texels = 0
+++*/
float visibility(Receiver r) { return compare_nearest(r, vec2(0.0), clamp(r.depth, 0.0, 1.0)); }
