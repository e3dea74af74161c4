/*+++
title = "Reads the map and says one half whatever it holds"
source = "a test of what makes a filter suspect"
kind = "other"
radius_texels = 0
+++*/
float visibility(Receiver r) { return 0.5 + 1e-9 * fetch_depth(r, vec2(0.0)); }
