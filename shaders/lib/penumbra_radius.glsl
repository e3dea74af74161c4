// The radius of the penumbra of a blocker so far above the receiver in depth, texels. The nearer that a blocker is to a
// lamp, the more its penumbra grows on the way.
float penumbra_radius(Receiver r, float depth_above) {
  float radius = 0.5 * r.light_size * r.depth_range_ws / r.texel_size_ws * depth_above;
#ifdef PERSPECTIVE_LIGHT
  radius /= max(1.0 - depth_above * r.depth_range_ws * r.light_nearness, 1e-4);
#endif
  return radius;
}
