// Weights of screen passes that blur within surfaces; filters/screen.h does the same.

// From 1 down to 0 where another pixel's surface is a radius away (metres), faces another way, or lies off this one's
// plane.
float near_on_surface(ScreenSurface here, ScreenSurface there, float radius) {
  vec3 between = there.position_ws - here.position_ws;
  float square = dot(between, between);
  float off_plane = dot(here.normal_ws, between);
  float turned = 1.0 - dot(here.normal_ws, there.normal_ws);
  return max(1.0 - square / (radius * radius), 0.0) * max(1.0 - 8.0 * turned, 0.0) *
         max(1.0 - 16.0 * off_plane * off_plane / max(square, 1e-12), 0.0);
}
