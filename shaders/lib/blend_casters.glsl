// Which texels of a map hold a caster that one sees through: those where its alpha is not below a threshold that is
// spread evenly over 0 .. 1.
#ifdef HASHED_CASTERS
#include "lib/hash.glsl"
in vec3 v_position_ws;

float hash_cell(vec3 position, float cells) {
  ivec3 cell = ivec3(floor(position * cells));
  return bits_to_turn(hash_bits(uint(cell.x) + hash_bits(uint(cell.y) + hash_bits(uint(cell.z)))));
}

// Wyman and McGuire 2017, Hashed Alpha Testing, I3D, section 3: a hash of the cell of space that a point lies in, so
// that the pattern stays on the surface. Cells are about as wide as a texel, by powers of two, between which two hashes
// are mixed; the distribution function of such a mixture makes it even again. Ours are hashes of whole numbers, of a
// place in the world, since meshes here do not move.
float find_threshold() {
  float step_ws = max(length(dFdx(v_position_ws)), length(dFdy(v_position_ws)));
  float level = -log2(max(step_ws, 1e-20));
  float share = fract(level), less = min(share, 1.0 - share);
  float cells = exp2(floor(level));
  float x = mix(hash_cell(v_position_ws, cells), hash_cell(v_position_ws, 2.0 * cells), share);
  float slope = max(2.0 * less * (1.0 - less), 1e-6);
  float even = x < less ? x * x / slope : x < 1.0 - less ? (x - 0.5 * less) / (1.0 - less)
                                                         : 1.0 - (1.0 - x) * (1.0 - x) / slope;
  return clamp(even, 1e-6, 1.0);
}
#else
// Bayer 1973, An Optimum Method for Two-Level Rendition of Continuous-Tone Pictures: the matrix of 8 x 8, by texel.
float find_threshold() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int order = 0;
  for (int bit = 0; bit < 3; ++bit)
    order = 4 * order + 2 * ((texel.x ^ texel.y) >> bit & 1) + (texel.y >> bit & 1);
  return (float(order) + 0.5) / 64.0;
}
#endif
