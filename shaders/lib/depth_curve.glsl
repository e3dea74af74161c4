// How the map stores depth; filters/depth_map.h does the same. Filters see linear depth, 0 near. With
// PERSPECTIVE_DEPTH the map holds the depth of a perspective projection; with REVERSED_DEPTH it holds 1 minus the depth.
#ifdef PERSPECTIVE_DEPTH
uniform float far_over_near;  // the distance of the far plane divided by that of the near plane

// Maps, lookups and models round alike, step by step; no compiler may fuse the steps in one of them.
float store_depth(float z) {
  z = max(z, 0.0);
  precise float steps = 1.0 + (far_over_near - 1.0) * z;
#ifdef REVERSED_DEPTH
  precise float stored = (1.0 - z) / steps;
#else
  precise float stored = far_over_near * z / steps;
#endif
  return stored;
}

float linear_depth(float stored) {
#ifdef REVERSED_DEPTH
  float away = stored;
#else
  float away = 1.0 - stored;
#endif
  precise float steps = 1.0 + (far_over_near - 1.0) * away;
  precise float z = (1.0 - away) / steps;
  return z;
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
