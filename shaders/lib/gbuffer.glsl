// Reads the G-buffer at this fragment; rows run bottom to top.
layout(binding = 8) uniform sampler2D gbuffer_position;    // xyz world space; w view depth, 0 where nothing was drawn
layout(binding = 9) uniform sampler2D gbuffer_normal;      // geometric, flipped to the viewer

bool is_background(ivec2 pixel) { return texelFetch(gbuffer_position, pixel, 0).w == 0.0; }
