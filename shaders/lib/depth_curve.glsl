// How the map stores depth; the same in filters/depth_curve.h. Filters see linear depth, 0 near: only here is it known
// that a map may hold the depth of a perspective projection (PERSPECTIVE_DEPTH: how many times as far its far plane is as
// its near plane), or one less its depth (REVERSED_DEPTH).
#ifdef PERSPECTIVE_DEPTH
float store_depth(float z) {
  z = max(z, 0.0);
  float steps = 1.0 + (PERSPECTIVE_DEPTH - 1.0) * z;
#ifdef REVERSED_DEPTH
  return (1.0 - z) / steps;
#else
  return PERSPECTIVE_DEPTH * z / steps;
#endif
}

float linear_depth(float stored) {
#ifdef REVERSED_DEPTH
  float away = stored;
#else
  float away = 1.0 - stored;
#endif
  return (1.0 - away) / (1.0 + (PERSPECTIVE_DEPTH - 1.0) * away);
}
#else
#ifdef REVERSED_DEPTH
float store_depth(float z) { return 1.0 - z; }
float linear_depth(float stored) { return 1.0 - stored; }
#else
float store_depth(float z) { return z; }
float linear_depth(float stored) { return stored; }
#endif
#endif
