// What a filter's screen passes are told, and how they read the picture; filters/screen.h does the same.

// Beside its result a filter's visibility() may leave a number of 0 or more for its screen passes, such as the width of
// a penumbra.
float screen_value = 0.0;

struct ScreenInput {
  ivec2 pixel;  // to write; (0,0) is the lower left
  ivec2 size;   // of the picture
  int step;     // 0, 1, 2, ... of its steps
};

struct ScreenSurface {
  vec3 position_ws;  // metres
  vec3 normal_ws;    // geometric, towards the viewer
  float view_depth;  // metres from the camera, along its axis; 0: nothing is there
};

layout(binding = 4) uniform sampler2D screen_image;  // visibility, value; that is negative where there is no receiver

#ifdef COUNT_FETCHES
int counted_screen_reads = 0;
int counted_screen_reach = 0;
#endif

void count_screen(ivec2 offset) {
#ifdef COUNT_FETCHES
  ++counted_screen_reads;
  counted_screen_reach = max(counted_screen_reach, max(abs(offset.x), abs(offset.y)));
#endif
}

bool is_on_screen(ScreenInput s, ivec2 offset) {
  ivec2 pixel = s.pixel + offset;
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, s.size));
}

// Visibility and value, as the step before left them, so many pixels off; the value is negative where no filter was
// asked: such a pixel has no part in any mean.
vec2 load_screen(ScreenInput s, ivec2 offset) {
  count_screen(offset);
  return is_on_screen(s, offset) ? texelFetch(screen_image, s.pixel + offset, 0).xy : vec2(0.0, -1.0);
}

ScreenSurface load_surface(ScreenInput s, ivec2 offset) {
  count_screen(offset);
  if (!is_on_screen(s, offset)) return ScreenSurface(vec3(0.0), vec3(0.0), 0.0);
  vec4 position = texelFetch(gbuffer_position, s.pixel + offset, 0);
  return ScreenSurface(position.xyz, texelFetch(gbuffer_normal, s.pixel + offset, 0).xyz, position.w);
}
