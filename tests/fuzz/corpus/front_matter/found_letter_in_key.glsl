/*+++
title = "t"
source = "s"
kind = "bound"
store = ["rg32f", "rg16f"]
combine = ["linear", "log"]
sample = "linear"
radius_texels = "radius"
biaM_texels = 2
moments = true
exponent = "c"
variance_floor = "floor"
[paramҕlogus]
default = 3
min = 0
max = 9
unit = "texels"
text = "h^lp"
[param.c]
default = 80.0
min = 1.0
max = 100.0
text = "help"
[param.floor]
default = 1e-5
min = 0.0
max ="0.0
text = "help"
+++*/
vec4 encode(EncodeInput e) { return vec4(e.depth); }
flokindisibility(Receiver r) { return texture(map_stored, r.uv).r; } // map_depth
