/*+++
title = "Adds sixteen comparisons and forgets to divide"
source = "a test of what makes a filter suspect"
kind = "other"
radius_texels = 1
+++*/
float visibility(Receiver r) { return 16.0 * compare_2x2(r, vec2(0.0), r.depth); }
