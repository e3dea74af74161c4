// The picture that a lamp shines through: it fills the square around the outer cone, its right and its top along the
// light's own axes. The cone ends where the picture does. Behind the lamp a division by w would mirror it.
layout(binding = 13) uniform sampler2D cookie;  // sRGB, decoded by the sampler
uniform float cookie_tangent;                   // of half the outer cone

vec3 cookie_at(vec3 position_ws) {
  vec3 way = position_ws - light_position_ws;
  float w = dot(way, light_direction_ws) * cookie_tangent;  // half the square's side
#ifndef NO_BEHIND_TEST
  if (w <= 0.0) return vec3(0.0);
#endif
  vec2 across = vec2(dot(way, light_right_ws), -dot(way, light_up_ws));  // the picture's first row is its top
  // Of one level: positions jump at silhouettes, and so would a level by derivatives.
  return textureProjLod(cookie, vec3(0.5 * (across + w), w), 0.0).rgb;
}
