// One direction of the separable Gaussian prefilter; with COMBINE_LOGS the texels hold logarithms. TAPS(tap) writes
// tap(i, weight) for every texel i of the kernel, so that nothing is looped over. What lies outside the map is the
// sampler's business.
layout(binding = 3) uniform sampler2D map_stored;  // nearest
uniform vec2 direction;
uniform float map_texel_uv;

layout(location = 0) out vec4 out_stored;

vec4 stored_at(float i) { return texture(map_stored, (gl_FragCoord.xy + i * direction) * map_texel_uv); }

void main() {
  vec4 sum = vec4(0.0);
#ifdef COMBINE_LOGS
  vec4 largest = stored_at(0.0);
#define TAKE_LARGEST(i, weight) largest = max(largest, stored_at(i));
  TAPS(TAKE_LARGEST)
#define ADD(i, weight) sum += weight * exp(stored_at(i) - largest);
  TAPS(ADD)
  out_stored = largest + log(sum);
#else
#define ADD(i, weight) sum += weight * stored_at(i);
  TAPS(ADD)
  out_stored = sum;
#endif
}
