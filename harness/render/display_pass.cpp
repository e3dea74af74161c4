#include "harness/render/display_pass.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "report/images/color_values.h"

namespace shadowbench::render {
namespace {

constexpr int kSteps = 256;

gl::Texture upload_scale(const char* label, const images::Image& colors) {
  gl::Texture scale(label, GL_RGBA32F, colors.width, 1);
  scale.upload_floats(colors.texels, 3);
  return scale;
}

images::Image make_grey() {
  return images::color_values(
      images::make_ramp(kSteps, 1),
      [](float t) {
        return images::Rgb{t, t, t};
      });
}

images::Image make_diverging() {
  return images::color_values(
      images::make_ramp(kSteps, 1), [](float t) { return images::map_diverging(2.0f * t - 1.0f, 1.0f); });
}

}  // namespace

DisplayPass::DisplayPass()
    : grey_(upload_scale("grey", make_grey())),
      diverging_(upload_scale("diverging", make_diverging())),
      sequential_(upload_scale("sequential", images::color_values(images::make_ramp(kSteps, 1), "viridis"))) {}

void DisplayPass::draw(ShaderLibrary& shaders, const std::array<DisplayedValues, 2>& sides, const DisplayPlace& place) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  draw_here(shaders, sides, place);
}

void DisplayPass::draw(ShaderLibrary& shaders, const std::array<DisplayedValues, 2>& sides, const DisplayPlace& place,
                       ImageTarget& target) {
  target.bind();
  draw_here(shaders, sides, place);
}

void DisplayPass::clear_window(const glm::ivec2& size, const glm::vec3& color) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, size.x, size.y);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(color.x, color.y, color.z, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

void DisplayPass::draw_here(ShaderLibrary& shaders, const std::array<DisplayedValues, 2>& sides,
                            const DisplayPlace& place) {
  gl::Program& program = shaders.fullscreen("display.frag");
  glViewport(place.corner.x, place.corner.y, place.size.x, place.size.y);
  for (GLuint side = 0; side < 2; ++side) {
    const DisplayedValues& shown = sides[side];
    for (const auto& [unit, texture] :
         {std::pair(side, shown.values), std::pair(side + 2, shown.less ? shown.less : shown.values),
          std::pair(side + 4, &scale_of(shown.colors))}) {
      gl::Sampler::unbind(unit);
      texture->bind(unit);
    }
    program.set(side == 0 ? "left_range" : "right_range",
                glm::vec4(shown.low, shown.high, static_cast<float>(shown.channel), shown.less ? 1.0f : 0.0f));
  }
  program.set("is_picture", glm::ivec2(sides[0].colors == Colors::kPicture, sides[1].colors == Colors::kPicture));
  program.set("corner", glm::vec2(place.corner));
  program.set("first_pixel", place.first_pixel);
  program.set("magnified", place.magnified);
  program.set("divider", place.divider);
  program.use();
  triangle_.draw();
}

const gl::Texture& DisplayPass::scale_of(Colors colors) const {
  if (colors == Colors::kDiverging) return diverging_;
  return colors == Colors::kSequential ? sequential_ : grey_;
}

unsigned gl_name(const gl::Texture& texture) { return texture.id(); }

}  // namespace shadowbench::render
