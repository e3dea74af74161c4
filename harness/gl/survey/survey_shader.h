#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "harness/gl/objects.h"
#include "harness/gl/fullscreen.h"
#include "harness/gl/program.h"

namespace shadowbench::gl {

/// Runs one of this folder's own fragment shaders over a grid and hands back what it wrote.
class SurveyShader {
 public:
  /// Takes an embedded shader's name, the grid's size and the format to write, R32F or wider.
  SurveyShader(const std::string& fragment, glm::ivec2 size, GLenum format = GL_R32F);

  Program& program() { return program_; }

  /// Queues one draw over the grid.
  void draw();

  /// Draws and returns all channels of the format, rows bottom to top.
  std::vector<float> run();

 private:
  Program program_;
  FullscreenTriangle triangle_;
  Texture target_;
  Framebuffer framebuffer_;
};

}  // namespace shadowbench::gl
