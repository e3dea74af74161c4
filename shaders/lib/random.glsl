// Random turns for filters, in integers so that every machine agrees; sources in filters/random.h. Every frame, which
// lib/receiver.glsl counts, turns on.
#include "lib/hash.glsl"
uniform uint run_seed;
layout(binding = 7) uniform sampler2D blue_noise;  // bound for filters that read it

// What a frame adds to its turns, in 2^-32 of a turn: the golden ratio.
uint frame_bits() { return 2654435769u * run_frame; }

float random_turn(ivec2 pixel) {
  return bits_to_turn(hash_bits(uint(pixel.x) + hash_bits(uint(pixel.y) + hash_bits(run_seed + frame_bits()))));
}

// The 64 bits of a product. WebGL has no function for it: there it is made of halves.
void multiply(uint a, uint b, out uint high, out uint low) {
#ifdef WEBGL
  uint a0 = a & 0xffffu, a1 = a >> 16, b0 = b & 0xffffu, b1 = b >> 16;
  uint middle = a1 * b0 + (a0 * b0 >> 16);
  uint carried = a0 * b1 + (middle & 0xffffu);
  high = a1 * b1 + (middle >> 16) + (carried >> 16);
  low = a * b;
#else
  umulExtended(a, b, high, low);
#endif
}

float interleaved_gradient_turn(ivec2 pixel) {
  uint inner = 288237660u * uint(pixel.x) + 25070368u * uint(pixel.y);
  uint high;
  uint low;
  multiply(inner, 3555623499u, high, low);
  return bits_to_turn(((high << 6) | (low >> 26)) + frame_bits());
}

// The texture repeats, and the seed shifts it.
float blue_noise_turn(ivec2 pixel) {
  uint shift = hash_bits(run_seed);
  uvec2 texel = (uvec2(pixel) + uvec2(shift, shift >> 16)) % uvec2(textureSize(blue_noise, 0));
  float turn = texelFetch(blue_noise, ivec2(texel), 0).r;
  return bits_to_turn((uint(turn * 16777216.0) << 8) + frame_bits());
}
