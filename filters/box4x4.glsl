/*+++
title = "3x3 box that slides with the receiver, in four hardware 2x2 fetches"
source = "Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH; box(3) convolved with box(1), per axis (1-s)/3, 1/3, 1/3, s/3; fetches placed as in Sigg and Hadwiger 2005, GPU Gems 2, ch. 20"
kind = "comparison"
radius_texels = 2
+++*/
float visibility(Receiver r) {
  vec2 s = texel_fraction(r);
  vec2 low = 1.0 / (2.0 - s) - 1.0 - s;  // between the texels that weigh (1-s)/3 and 1/3
  vec2 high = s / (1.0 + s) + 1.0 - s;   // between those that weigh 1/3 and s/3
  vec2 share = (1.0 + s) / 3.0;          // of the high fetch
  float bottom = mix(compare_2x2(r, low, r.depth), compare_2x2(r, vec2(high.x, low.y), r.depth), share.x);
  float top = mix(compare_2x2(r, vec2(low.x, high.y), r.depth), compare_2x2(r, high, r.depth), share.x);
  return mix(bottom, top, share.y);
}
