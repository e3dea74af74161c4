#pragma once

namespace shadowbench::images {

/// A rectangle of pixels; empty where its width is 0.
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// A width and a height, in pixels.
struct Size {
  int width = 0;
  int height = 0;
};

}  // namespace shadowbench::images
