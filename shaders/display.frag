// Shows a picture (PICTURE), or the values of its pixels in colours.
layout(binding = 0) uniform sampler2D values;
#ifndef PICTURE
layout(binding = 1) uniform sampler2D less;
layout(binding = 2) uniform sampler2D colors;
uniform vec2 range;  // gets the first of the colours, and the last
uniform int channel;
uniform int has_less;  // whether something is taken away
#endif
uniform vec2 corner;       // of what is drawn, in the target's pixels; the lower left
uniform vec2 first_pixel;  // of the picture, that is shown there
uniform float pixels_per_target;

layout(location = 0) out vec4 out_color;

const vec3 broken = vec3(1.0, 0.0, 1.0);
const vec3 endless = vec3(1.0);
const vec3 outside = vec3(0.12, 0.12, 0.13);

vec3 encode_srgb(vec3 linear) {
  vec3 clamped = clamp(linear, 0.0, 1.0);
  return mix(12.92 * clamped, 1.055 * pow(clamped, vec3(1.0 / 2.4)) - 0.055, greaterThan(clamped, vec3(0.0031308)));
}

vec3 show(ivec2 pixel) {
  vec4 texel = texelFetch(values, pixel, 0);
#ifdef PICTURE
  return any(isnan(texel.rgb)) ? broken : encode_srgb(texel.rgb);
#else
  float value = texel[channel];
  if (has_less != 0) value -= texelFetch(less, pixel, 0).x;
  if (isnan(value)) return broken;
  if (isinf(value)) return endless;
  int last = textureSize(colors, 0).x - 1;
  float place = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0) * float(last);
  int below = int(place);
  return mix(texelFetch(colors, ivec2(below, 0), 0).rgb, texelFetch(colors, ivec2(min(below + 1, last), 0), 0).rgb,
             place - float(below));
#endif
}

void main() {
  ivec2 pixel = ivec2(floor((gl_FragCoord.xy - corner) * pixels_per_target + first_pixel));
  bool is_inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, textureSize(values, 0)));
  out_color = vec4(is_inside ? show(pixel) : outside, 1.0);
}
