// A disk of points, turned at each pixel. A filter that includes this declares a parameter `rotation` with the choices
// of filters/poisson.glsl; filters/penumbra.h does the same.

// Cosine and sine of the disk's turn.
vec2 find_turn(ivec2 pixel) {
  float turn = 0.0;
  if (rotation == ROTATION_PER_PIXEL) turn = random_turn(pixel);
  if (rotation == ROTATION_INTERLEAVED_GRADIENT) turn = interleaved_gradient_turn(pixel);
  if (rotation == ROTATION_BLUE_NOISE) turn = blue_noise_turn(pixel);
  float angle = 6.28318530718 * turn;
  return vec2(cos(angle), sin(angle));
}

vec2 rotate(vec2 p, vec2 turn) { return vec2(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y); }
