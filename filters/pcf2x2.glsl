/*+++
title = "Hardware 2x2 PCF"
source = "Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH; OpenGL 4.5, section 8.23"
kind = "comparison"
radius_texels = 1
+++*/
float visibility(Receiver r) { return compare_2x2(r, vec2(0.0), r.depth); }
