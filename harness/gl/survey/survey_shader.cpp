#include "harness/gl/survey/survey_shader.h"


namespace shadowbench::gl {

SurveyShader::SurveyShader(const std::string& fragment, glm::ivec2 size, GLenum format)
    : program_(fragment, FullscreenTriangle::vertex_source(), embedded_source(fragment)),
      target_(fragment, format, size.x, size.y),
      framebuffer_(fragment) {
  framebuffer_.attach_color(0, target_);
}

void SurveyShader::draw() {
  framebuffer_.bind();
  program_.use();
  triangle_.draw();
}

std::vector<float> SurveyShader::run() {
  draw();
  return target_.read_floats(target_.format().channels);
}

}  // namespace shadowbench::gl
