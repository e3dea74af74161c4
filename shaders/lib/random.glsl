// Random turns for filters, in integers so that every machine agrees; sources in filters/random.h.
uniform uint run_seed;

uint hash_bits(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

float bits_to_turn(uint bits) { return float(bits >> 8) * exp2(-24.0); }

float random_turn(ivec2 pixel) {
  return bits_to_turn(hash_bits(uint(pixel.x) + hash_bits(uint(pixel.y) + hash_bits(run_seed))));
}

float interleaved_gradient_turn(ivec2 pixel) {
  uint inner = 288237660u * uint(pixel.x) + 25070368u * uint(pixel.y);
  uint high;
  uint low;
  umulExtended(inner, 3555623499u, high, low);
  return bits_to_turn((high << 6) | (low >> 26));
}
