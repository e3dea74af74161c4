// Blinn-Phong; only the direct light is shadowed, the ambient part never is.
// Source: Blinn 1977, Models of Light Reflection for Computer Synthesized Pictures, SIGGRAPH.
#include "lib/gbuffer.glsl"
#include "lib/light.glsl"
layout(binding = 10) uniform sampler2D gbuffer_shading_normal;
layout(binding = 11) uniform sampler2D gbuffer_albedo;
layout(binding = 4) uniform sampler2D visibility_image;
uniform vec3 camera_position_ws;
uniform vec3 camera_forward_ws;
uniform int orthographic;
uniform vec3 light_radiance;  // linear
uniform vec3 background;      // linear

layout(location = 0) out vec4 out_color;

uniform float ambient_at_side;  // of what comes from above, where a surface is upright

const float kAmbient = 0.22;
const float kSpecular = 0.12;
const float kShininess = 40.0;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  out_color = vec4(background, 1.0);
  if (is_background(pixel)) return;
  vec3 position = texelFetch(gbuffer_position, pixel, 0).xyz;
  vec3 normal = texelFetch(gbuffer_shading_normal, pixel, 0).xyz;
  vec3 albedo = texelFetch(gbuffer_albedo, pixel, 0).rgb;
  vec3 to_light = direction_to_light(position);
  vec3 to_viewer = orthographic == 1 ? -camera_forward_ws : normalize(camera_position_ws - position);
  float n_dot_l = max(dot(normal, to_light), 0.0);
  float specular = n_dot_l > 0.0 ? kSpecular * pow(max(dot(normal, normalize(to_light + to_viewer)), 0.0), kShininess) : 0.0;
  float visibility = texelFetch(visibility_image, pixel, 0).r;
  // The sky is brighter than the ground, so that ambient light models form as well.
  vec3 ambient = kAmbient * (ambient_at_side + (1.0 - ambient_at_side) * normal.y) * albedo;
  out_color = vec4(ambient + visibility * light_strength(position) * light_radiance * (albedo * n_dot_l + specular), 1.0);
}
