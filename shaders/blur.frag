// One direction of the separable Gaussian prefilter; with COMBINE_LOGS the texels hold logarithms.
// BORDER_EDGE and BORDER_REPEAT are there to show what they do wrong.
layout(binding = 3) uniform sampler2D map_stored;
uniform ivec2 direction;
uniform int radius;
uniform float weights[129];
uniform vec4 border;

layout(location = 0) out vec4 out_stored;

vec4 tap(int i) {
  ivec2 texel = ivec2(gl_FragCoord.xy) + i * direction;
  ivec2 size = textureSize(map_stored, 0);
#if defined(BORDER_EDGE)
  return texelFetch(map_stored, clamp(texel, ivec2(0), size - 1), 0);
#elif defined(BORDER_REPEAT)
  return texelFetch(map_stored, (texel + radius * size) % size, 0);
#else
  bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
  return inside ? texelFetch(map_stored, texel, 0) : border;
#endif
}

void main() {
  vec4 sum = vec4(0.0);
#ifdef COMBINE_LOGS
  vec4 largest = tap(-radius);
  for (int i = -radius; i <= radius; ++i) largest = max(largest, tap(i));
  for (int i = -radius; i <= radius; ++i) sum += weights[i + radius] * exp(tap(i) - largest);
  out_stored = largest + log(sum);
#else
  for (int i = -radius; i <= radius; ++i) sum += weights[i + radius] * tap(i);
  out_stored = sum;
#endif
}
