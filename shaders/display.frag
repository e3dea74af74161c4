// Shows values of a picture's pixels in colours: on the left of the divider those of one side, on the right the other's.
layout(binding = 0) uniform sampler2D left_values;
layout(binding = 1) uniform sampler2D right_values;
layout(binding = 2) uniform sampler2D left_less;
layout(binding = 3) uniform sampler2D right_less;
layout(binding = 4) uniform sampler2D left_colors;
layout(binding = 5) uniform sampler2D right_colors;
uniform vec2 corner;       // of what is drawn, in the target's pixels; the lower left
uniform vec2 first_pixel;  // of the picture, that is shown there
uniform float magnified;   // the target's pixels for each of the picture's
uniform float divider;     // the picture's column from which on the right side is shown
uniform vec4 left_range;   // low, high, channel, whether something is taken away
uniform vec4 right_range;
uniform ivec2 is_picture;  // of the left and of the right: linear RGB, and no values

layout(location = 0) out vec4 out_color;

const vec3 kBroken = vec3(1.0, 0.0, 1.0);

vec3 encode_srgb(vec3 linear) {
  vec3 clamped = clamp(linear, 0.0, 1.0);
  return mix(12.92 * clamped, 1.055 * pow(clamped, vec3(1.0 / 2.4)) - 0.055, greaterThan(clamped, vec3(0.0031308)));
}

vec3 show(sampler2D values, sampler2D less, sampler2D colors, vec4 range, bool linear_rgb, ivec2 pixel) {
  vec4 texel = texelFetch(values, pixel, 0);
  if (linear_rgb) return any(isnan(texel.rgb)) ? kBroken : encode_srgb(texel.rgb);
  float value = texel[int(range.z)];
  if (range.w > 0.0) value -= texelFetch(less, pixel, 0).x;
  if (isnan(value)) return kBroken;
  float place = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
  float step = place * float(textureSize(colors, 0).x - 1);
  int below = int(step);
  return mix(texelFetch(colors, ivec2(below, 0), 0).rgb,
             texelFetch(colors, ivec2(min(below + 1, textureSize(colors, 0).x - 1), 0), 0).rgb, step - float(below));
}

void main() {
  vec2 at = (gl_FragCoord.xy - corner) / magnified + first_pixel;
  ivec2 pixel = ivec2(floor(at));
  out_color = vec4(0.12, 0.12, 0.13, 1.0);
  bool is_left = at.x < divider;
  ivec2 size = is_left ? textureSize(left_values, 0) : textureSize(right_values, 0);
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) return;
  out_color.rgb = is_left ? show(left_values, left_less, left_colors, left_range, is_picture.x != 0, pixel)
                          : show(right_values, right_less, right_colors, right_range, is_picture.y != 0, pixel);
}
