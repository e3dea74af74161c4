// Mixes the bits of a number; source in filters/random.h.
uint hash_bits(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

float bits_to_turn(uint bits) { return float(bits >> 8) * exp2(-24.0); }
