/*+++
title = "A comparison, and its mean over pixels in a row"
source = "ours"
kind = "other"
radius_texels = 1
[param.side]
default = 1
min = 0
max = 3
text = "pixels on each side; 2 or more are further than is declared"
[param.spoil]
default = "nothing"
choices = ["nothing", "not-finite", "endless"]
text = "what the second pass does beside its work"
[screen.row]
reach = 1
[screen.halve]
reach = 0
steps = 2
+++*/
float visibility(Receiver r) {
  screen_value = 3.0;
  return compare_nearest(r, vec2(0.0), r.depth);
}

vec2 row(ScreenInput s) {
  float sum = 0.0, count = 0.0;
  for (int x = -side; x <= side; ++x) {
    vec2 there = load_screen(s, ivec2(x, 0));
    if (there.y < 0.0) continue;
    sum += there.x;
    count += 1.0;
  }
  return vec2(sum / count, load_screen(s, ivec2(0)).y - 2.0);
}

// Visibility is a quarter of the mean in the end.
vec2 halve(ScreenInput s) {
  vec2 own = load_screen(s, ivec2(0));
  if (spoil == SPOIL_NOT_FINITE) own.x = sqrt(-1.0 - own.x);
  for (int i = 0; spoil == SPOIL_ENDLESS && i < 1000000; ++i) own.x += 1e-12 * float(i % 2);
  return 0.5 * own;
}
