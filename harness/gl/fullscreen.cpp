#include "harness/gl/fullscreen.h"

namespace shadowbench::gl {

FullscreenTriangle::FullscreenTriangle() : empty_("fullscreen triangle") {}

void FullscreenTriangle::set_state() const {
  for (const GLenum capability : {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_BLEND, GL_CULL_FACE,
                                  GL_POLYGON_OFFSET_FILL, GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP})
    glDisable(capability);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  empty_.bind();
}

void FullscreenTriangle::draw() const {
  set_state();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void FullscreenTriangle::draw_added() const {
  set_masked();
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void FullscreenTriangle::draw_masked() const {
  set_masked();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// The triangle lies at depth 0.
void FullscreenTriangle::set_masked() const {
  set_state();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
}

void FullscreenTriangle::draw_depth() const {
  set_state();
  glEnable(GL_DEPTH_TEST);  // without the test there is no writing either
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

ShaderSource FullscreenTriangle::vertex_source() { return embedded_source("fullscreen.vert"); }

}  // namespace shadowbench::gl
