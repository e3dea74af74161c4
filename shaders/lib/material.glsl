// A surface's colour; the variants are compiled only where a scene needs them.
uniform vec4 base_color;  // linear
#ifdef HAS_TEXTURE
layout(binding = 12) uniform sampler2D base_color_texture;  // sRGB, decoded by the sampler
#endif
#ifdef ALPHA_MASK
uniform float alpha_cutoff;
#endif

vec4 surface_color(vec2 uv) {
  vec4 color = base_color;
#ifdef HAS_TEXTURE
  color *= texture(base_color_texture, uv);
#endif
#ifdef ALPHA_MASK
  if (color.a < alpha_cutoff) discard;
#endif
  return color;
}
