/*+++
title = "Variance shadow map with mips"
source = "Donnelly and Lauritzen 2006, Variance Shadow Maps, I3D"
kind = "other"
store = "rg32f"
radius_texels = 1
moments = true
[param.lookup]
default = "anisotropic"
choices = ["finest", "mips", "anisotropic"]
text = "what is read for a pixel: finest flickers, mips blurs in the distance, anisotropic costs the most fetches"
[pass.mips]
store = "rg32f"
steps = "levels"
anisotropy = 16
+++*/
vec4 encode(EncodeInput e) {
  return vec4(e.depth, e.depth * e.depth + 0.25 * dot(e.depth_per_texel, e.depth_per_texel), 0.0, 0.0);
}

vec4 mips(PassInput p) {
  if (p.step == 0) return load_map(p.texel);
  ivec2 t = 2 * p.texel;
  int finer = p.step - 1;
  return 0.25 * (load_mips(t, finer) + load_mips(t + ivec2(1, 0), finer) +
                 load_mips(t + ivec2(0, 1), finer) + load_mips(t + 1, finer));
}

float visibility(Receiver r) {
  mat2 sides = texels_per_pixel(r);
  vec2 longer = length(sides[0]) > length(sides[1]) ? sides[0] : sides[1];
  if (lookup == LOOKUP_FINEST) sides = mat2(0.0);
  if (lookup == LOOKUP_MIPS) sides = mat2(longer, longer);  // a square: one fetch
  vec2 moments = fetch_mips_grad(r, vec2(0.0), sides[0], sides[1]).xy;
  float distance = r.depth - moments.x;
  if (distance <= 0.0) return 1.0;
  float variance = max(moments.y - moments.x * moments.x, 1e-6);
  return variance / (variance + distance * distance);
}
