/*+++
title = "Guesses from the pixel"
source = "a test of what makes a filter suspect"
kind = "other"
radius_texels = 0
+++*/
float visibility(Receiver r) { return random_turn(r.pixel) < 0.5 ? 0.0 : 1.0; }
