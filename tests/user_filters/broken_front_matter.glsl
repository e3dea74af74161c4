/*+++
title = "Has a mistake in its front matter"
source = "a test"
kind = "comparison"
radius_texels = 0
[param.width]
defualt = 1.0
+++*/
float visibility(Receiver r) { return 1.0; }
