// How the map stores depth; filters/depth_curve.h does the same. Filters see linear depth, 0 near. With
// PERSPECTIVE_DEPTH, the distance of the far plane divided by that of the near plane, the map holds the depth of a
// perspective projection; with REVERSED_DEPTH it holds 1 minus the depth.
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
