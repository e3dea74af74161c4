/*+++
title = "1 where gathers agree with the fetches of the same texels, else 0"
source = "a test of gathers"
kind = "other"
radius_texels = 3
+++*/
float visibility(Receiver r) {
  vec2 t = texel_fraction(r);
  vec2 within = vec2(0.25, 0.625);                 // of the four texels, where compare_2x2 reads
  vec2 low = vec2(1.0, -2.0) - t;                  // the lower left one's centre
  vec4 lit = gather_compare(r, low + 0.5, r.depth);
  float weighed = mix(mix(lit.w, lit.z, within.x), mix(lit.x, lit.y, within.x), within.y);
  bool same = abs(weighed - compare_2x2(r, low + within, r.depth)) < 1e-2;
  vec4 depths = gather_depth(r, low + 0.5);
  same = same && depths.x == fetch_depth(r, low + vec2(0.0, 1.0)) && depths.y == fetch_depth(r, low + 1.0);
  same = same && depths.z == fetch_depth(r, low + vec2(1.0, 0.0)) && depths.w == fetch_depth(r, low);
  return same ? 1.0 : 0.0;
}
