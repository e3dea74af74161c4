#include "harness/render/display_pass.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::render {
namespace {

constexpr int kSteps = 256;

gl::Texture upload_scale(const char* label, const images::Image& colors) {
  gl::Texture scale(label, GL_RGBA32F, colors.width, 1);
  scale.upload_floats(colors.texels, 3);
  return scale;
}

images::Image color_ramp(Colors colors) {
  return images::color_values(images::make_ramp(kSteps, 1), color_function(colors));
}

}  // namespace

images::Colors color_function(Colors colors) {
  if (colors == Colors::kGrey) return images::map_grey;
  if (colors == Colors::kSequential) return images::color_map("viridis");
  return [](float place) { return images::map_diverging(2.0f * place - 1.0f, 1.0f); };
}

DisplayPass::DisplayPass()
    : grey_(upload_scale("grey", color_ramp(Colors::kGrey))),
      diverging_(upload_scale("diverging", color_ramp(Colors::kDiverging))),
      sequential_(upload_scale("sequential", color_ramp(Colors::kSequential))) {}

void DisplayPass::clear_window(const glm::ivec2& size, const glm::vec3& color) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, size.x, size.y);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(color.x, color.y, color.z, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

void DisplayPass::draw(ShaderLibrary& shaders, const std::array<DisplayedValues, 2>& sides, const DisplayPlace& place,
                       ImageTarget* target) {
  if (target)
    target->bind();
  else
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  const float column = (place.divider - place.first_pixel.x) * place.magnified;
  const int left = std::clamp(static_cast<int>(std::lround(column)), 0, place.size.x);
  draw_side(shaders, sides[0], place, 0, left);
  draw_side(shaders, sides[1], place, left, place.size.x);
}

/// Draws columns of the place, from one up to another.
void DisplayPass::draw_side(ShaderLibrary& shaders, const DisplayedValues& shown, const DisplayPlace& place, int from,
                            int to) {
  if (from == to) return;
  const bool is_picture = shown.colors == Colors::kPicture;
  gl::Program& program = shaders.fullscreen("display.frag", is_picture ? Defines{{"PICTURE", "1"}} : Defines{});
  glViewport(place.corner.x + from, place.corner.y, to - from, place.size.y);
  gl::Sampler::unbind(0);
  shown.values->bind(0);
  if (!is_picture) {
    for (const GLuint unit : {1U, 2U}) gl::Sampler::unbind(unit);
    (shown.less ? shown.less : shown.values)->bind(1);
    scale_of(shown.colors).bind(2);
    program.set("range", glm::vec2(shown.low, shown.high));
    program.set("channel", shown.channel);
    program.set("has_less", shown.less ? 1 : 0);
  }
  program.set("corner", glm::vec2(place.corner));
  program.set("first_pixel", place.first_pixel);
  program.set("pixels_per_target", 1.0f / place.magnified);
  program.use();
  triangle_.draw();
}

const gl::Texture& DisplayPass::scale_of(Colors colors) const {
  if (colors == Colors::kDiverging) return diverging_;
  return colors == Colors::kSequential ? sequential_ : grey_;
}

}  // namespace shadowbench::render
