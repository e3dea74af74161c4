#pragma once

#include "harness/gl/objects.h"
#include "harness/gl/shader_source.h"

namespace shadowbench::gl {

/// Draws one triangle that covers the viewport.
class FullscreenTriangle {
 public:
  FullscreenTriangle();

  /// Draws with the program and framebuffer in use, having turned off depth, stencil and scissor test, blending,
  /// culling and polygon offset, opened the colour mask, and set polygon mode to fill.
  void draw() const;

  /// The same where the framebuffer's depth is 0, adding what the program writes to what is there.
  void draw_added() const;

  /// The same without adding.
  void draw_masked() const;

  /// The same for a program that writes gl_FragDepth into a framebuffer's depth, whatever is there.
  void draw_depth() const;

  /// Returns the vertex shader that goes with it. Its output `vec2 v_uv` is (0,0) at the lower left of the viewport.
  static ShaderSource vertex_source();

 private:
  VertexArray empty_;

  void set_state() const;
  void set_masked() const;
};

}  // namespace shadowbench::gl
