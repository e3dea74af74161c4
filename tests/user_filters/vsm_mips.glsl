/*+++
title = "Variance shadow map with mips"
source = "Donnelly and Lauritzen 2006, Variance Shadow Maps, I3D; light-bleeding reduction: Lauritzen 2007, GPU Gems 3, ch. 8"
kind = "other"
store = "rg32f"
radius_texels = 8  # a pixel may cover more: the map's margin is not made for that
bias_texels = 1
moments = true
[param.lookup]
default = "anisotropic"
choices = ["finest", "mips", "anisotropic"]
text = "finest reads the map as it is, mips one mean over the longest side of a pixel's footprint, anisotropic several along it"
[param.bleed_reduction]
default = 0.3
min = 0.0
max = 0.9
text = "visibility below this is dark; too much darkens penumbrae"
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
  return 0.25 * (load_mips(t, finer) + load_mips(t + ivec2(1, 0), finer) + load_mips(t + ivec2(0, 1), finer) +
                 load_mips(t + 1, finer));
}

vec2 moments_at(Receiver r) {
  if (lookup == LOOKUP_FINEST) return fetch_map(r, vec2(0.0)).xy;
  mat2 pixel = texels_per_pixel(r);
  if (lookup == LOOKUP_ANISOTROPIC) return fetch_mips_grad(r, vec2(0.0), pixel[0], pixel[1]).xy;
  return fetch_mips_lod(r, vec2(0.0), max(log2(max(length(pixel[0]), length(pixel[1]))), 0.0)).xy;
}

float visibility(Receiver r) {
  vec2 moments = moments_at(r);
  float distance = r.depth - moments.x;
  if (distance <= 0.0) return 1.0;
  float variance = max(moments.y - moments.x * moments.x, 1e-5);
  return max(variance / (variance + distance * distance) - bleed_reduction, 0.0) / (1.0 - bleed_reduction);
}
