// What a pass of a filter's own is told.
struct PassInput {
  ivec2 texel;      // of the map that it writes
  ivec2 size;       // of that map, at this level
  int step;         // 0, 1, 2, ... of its steps
  ivec2 direction;  // axes and prefix sums, from step 1 on: (1, 0), and then (0, 1)
  int stride;       // prefix sums: 1, 4, 16, ... from step 1 on
};
