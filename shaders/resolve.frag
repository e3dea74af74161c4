// Accumulates visibility over frames: what was resolved before, found again by the receiver's position, and this frame
// by its weight. harness/render/picture_passes.h names the sources.
#include "lib/gbuffer.glsl"
layout(binding = 4) uniform sampler2D visibility_image;
layout(binding = 12) uniform sampler2D history;  // resolved visibility, frames it holds, view depth; 0 frames: nothing
uniform mat4 clip_now;                           // without jitter
uniform mat4 clip_before;
uniform vec4 depth_before;  // gives the view depth that a point had
uniform float least_weight;
uniform int clamps;

layout(location = 0) out vec4 out_resolved;

const float depth_margin = 0.01;  // of the depth

vec2 pixel_at(mat4 clip, vec3 position) {
  vec4 place = clip * vec4(position, 1.0);
  return (0.5 * place.xy / place.w + 0.5) * vec2(textureSize(history, 0));
}

// The pixel that lies x and y pixels off, or the one at the picture's edge.
ivec2 neighbour(ivec2 pixel, int x, int y) {
  return clamp(pixel + ivec2(x, y), ivec2(0), textureSize(history, 0) - 1);
}

// Whether some pixel around showed a surface as far away: jitter alone must not look as if it had been hidden.
bool was_seen(ivec2 pixel, float depth) {
  float nearest = 1e30, farthest = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float shown = texelFetch(history, neighbour(pixel, x, y), 0).z;
      if (shown == 0.0) continue;
      nearest = min(nearest, shown);
      farthest = max(farthest, shown);
    }
  }
  return depth >= (1.0 - depth_margin) * nearest && depth <= (1.0 + depth_margin) * farthest;
}

// Between the four pixels around a place; exactly one of them at its centre.
float read_history(vec2 place) {
  ivec2 pixel = ivec2(floor(place - 0.5));
  vec2 part = place - 0.5 - vec2(pixel);
  vec4 values = vec4(texelFetch(history, neighbour(pixel, 0, 0), 0).x, texelFetch(history, neighbour(pixel, 1, 0), 0).x,
                     texelFetch(history, neighbour(pixel, 0, 1), 0).x, texelFetch(history, neighbour(pixel, 1, 1), 0).x);
  return mix(mix(values.x, values.y, part.x), mix(values.z, values.w, part.x), part.y);
}

float clamp_to_neighbours(ivec2 pixel, float value) {
  float least = 1e30, most = -1e30;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float shown = texelFetch(visibility_image, neighbour(pixel, x, y), 0).r;
      least = min(least, shown);
      most = max(most, shown);
    }
  }
  return clamp(value, least, most);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float now = texelFetch(visibility_image, pixel, 0).r;
  vec4 receiver = texelFetch(gbuffer_position, pixel, 0);
  out_resolved = vec4(now, 1.0, receiver.w, 0.0);
  // The background is as far away wherever the camera stands, and of a camera that stands still rounding moves nothing.
  vec2 place = vec2(pixel) + 0.5;
  if (receiver.w > 0.0 && clip_before != clip_now)
    place += pixel_at(clip_before, receiver.xyz) - pixel_at(clip_now, receiver.xyz);
  ivec2 there = ivec2(floor(place));
  if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, textureSize(history, 0)))) return;
  float frames = texelFetch(history, there, 0).y;
  bool is_known = receiver.w == 0.0 || was_seen(there, dot(depth_before, vec4(receiver.xyz, 1.0)));
  if (frames == 0.0 || !is_known) return;
  float before = read_history(place);
  if (clamps != 0) before = clamp_to_neighbours(pixel, before);
  float weight = max(1.0 / (frames + 1.0), least_weight);
  out_resolved.x = weight == 1.0 ? now : before + weight * (now - before);  // equal frames stay as they are, to the bit
  out_resolved.y = frames + 1.0;
}
