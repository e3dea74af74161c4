/*+++
title = "t"
source = "s"
kind = "comparison"
radius_texels = "radius"
[param.radius]
default = 2.0
min = 0.5
max = 9.0
text = "help"
[kernel]
weights = [1, 3, 4, 3, 1]
read = "bilinear"
+++*/
float visibility(Receiver r) { return compare_2x2(r, vec2(0.0), r.depth); }
