// What encode() is told of a texel of the depth map.
struct EncodeInput {
  float depth;            // [0,1]
  vec2 depth_per_texel;   // of the stored surface, the smaller of the two one-sided differences per axis
};
