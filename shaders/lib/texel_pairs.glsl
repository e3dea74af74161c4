// Separable kernels in pairs * pairs fetches, or gathers, of 2x2 texels. A filter says `const int pairs` before it
// includes this file. Along each axis, a kernel weighs 2 * pairs texels, of which the first lies pairs - 1 before
// the one that texel_fraction() counts from; filters/texel_pairs.h does the same.

// A triangle of half-width h, which is pairs - 1/2 texels, integrated over every texel. At a distance d from its
// top, a texel gets (h - d) / h^2; the one under the top loses (1/2 - d)^2 / h^2, which the fold cuts off, and the
// last one on each side is a triangle of its own, with legs of t or 1 - t.
vec2[2 * pairs] triangle_weights(float h, vec2 t) {
  vec2 weights[2 * pairs];
  weights[0] = 0.5 * (1.0 - t) * (1.0 - t) / (h * h);
  weights[2 * pairs - 1] = 0.5 * t * t / (h * h);
  for (int i = 1; i < 2 * pairs - 1; ++i) {
    vec2 d = abs(float(i + 1 - pairs) - t);
    vec2 fold = max(0.5 - d, 0.0);
    weights[i] = (h - d - fold * fold) / (h * h);
  }
  return weights;
}

// The weights of a kernel that is given at whole texels, interpolated linearly between two of them; they sum to 1.
vec2[2 * pairs] sliding_weights(float at_texels[2 * pairs - 1], vec2 t) {
  float all = 0.0;
  for (int i = 0; i < 2 * pairs - 1; ++i) all += at_texels[i];
  for (int i = 0; i < 2 * pairs - 1; ++i) at_texels[i] /= all;
  vec2 weights[2 * pairs];
  weights[0] = at_texels[0] * (1.0 - t);
  weights[2 * pairs - 1] = at_texels[2 * pairs - 2] * t;
  for (int i = 1; i < 2 * pairs - 1; ++i) weights[i] = mix(vec2(at_texels[i]), vec2(at_texels[i - 1]), t);
  return weights;
}

// The same, with weights from a table of several kernels, in which this one begins at `first`.
vec2[2 * pairs] sliding_weights(float table[15], int first, vec2 t) {
  float at_texels[2 * pairs - 1];
  for (int i = 0; i < 2 * pairs - 1; ++i) at_texels[i] = table[first + i];
  return sliding_weights(at_texels, t);
}

// The comparisons of these texels, with weights that sum to 1. A fetch lies between two texels where the hardware
// weighs them as the kernel does, and counts for both.
float compare_pairs(Receiver r, vec2 weights[2 * pairs], float z) {
  vec2 t = texel_fraction(r);
  vec2 both[pairs];
  vec2 offset[pairs];
  for (int i = 0; i < pairs; ++i) {
    both[i] = weights[2 * i] + weights[2 * i + 1];
    offset[i] = float(2 * i + 1 - pairs) - t + weights[2 * i + 1] / both[i];
  }
  float sum = 0.0;
  for (int y = 0; y < pairs; ++y)
    for (int x = 0; x < pairs; ++x)
      sum += both[x].x * both[y].y * compare_2x2(r, vec2(offset[x].x, offset[y].y), z);
  return min(sum, 1.0);  // weights that sum to 1 may round to more
}

// The same, with a gather in the middle of four texels, and the weights put to them here.
float gather_pairs(Receiver r, vec2 weights[2 * pairs], float z) {
  vec2 first = 1.5 - float(pairs) - texel_fraction(r);
  float sum = 0.0;
  for (int y = 0; y < pairs; ++y) {
    for (int x = 0; x < pairs; ++x) {
      vec4 lit = gather_compare(r, first + vec2(2 * x, 2 * y), z);
      vec2 columns = vec2(weights[2 * x].x, weights[2 * x + 1].x);
      sum += weights[2 * y].y * dot(columns, lit.wz) + weights[2 * y + 1].y * dot(columns, lit.xy);
    }
  }
  return min(sum, 1.0);
}
