#include "harness/render/picture_passes.h"

#include <algorithm>
#include <cmath>

#include "harness/gl/program.h"
#include "harness/render/gbuffer.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kVisibilityUnit = 4;  // of shade.frag

Defines shade_defines(const scene::Light& light, const filters::RangeRule& range) {
  Defines defines;
  if (scene::find_beam(light)) defines.push_back(kPerspectiveLight);
  if (scene::find_beam(light) && !range.behind_test) defines.emplace_back("NO_BEHIND_TEST", "1");
  return defines;
}

constexpr int kSteps = 256;

gl::Texture upload_scale(Colors colors) {
  gl::Texture scale("scale of colours", GL_RGBA32F, kSteps, 1);
  scale.upload_floats(images::color_values(images::make_ramp(kSteps, 1), color_function(colors)).texels, 3);
  return scale;
}

constexpr GLuint kAddedUnit = 4, kHistoryUnit = 12;  // of resolve.frag

/// Gives the distance of a point from a camera along its axis, as gbuffer.frag has it.
glm::vec4 make_depth_plane(const scene::Camera& camera) {
  return glm::vec4(camera.forward_ws, -glm::dot(camera.forward_ws, camera.position_ws));
}

}  // namespace

void shade_into(ImageTarget& target, ShaderLibrary& shaders, const ShadedView& view, const glm::ivec2& columns) {
  const auto& [gbuffer, visibility, scene, camera, range] = view;
  const std::optional<scene::Beam> beam = scene::find_beam(scene.light);
  gl::Program& program = shaders.fullscreen("shade.frag", shade_defines(scene.light, range));
  program.set("camera_position_ws", camera.position_ws);
  program.set("camera_forward_ws", camera.forward_ws);
  program.set("orthographic", camera.orthographic_height_m > 0.0f ? 1 : 0);
  if (beam)
    set_beam(program, *beam);
  else
    program.set("light_direction_ws", -scene::to_light(scene.light, {}));
  program.set("light_radiance", scene.light.color * scene.light.intensity);
  program.set("background", scene.background);
  program.set("ambient_at_side", kAmbientAtSide);
  target.bind();
  glViewport(columns.x, 0, columns.y - columns.x, gbuffer.height());
  gbuffer.bind();
  visibility.bind(kVisibilityUnit);
  program.use();
  gl::FullscreenTriangle().draw();
}

images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera, const filters::RangeRule& range) {
  ImageTarget target("picture", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  shade_into(target, shaders, {gbuffer, visibility, scene, camera, range}, {0, gbuffer.width()});
  return read_image(target.texture(), 3);
}

images::Colors color_function(Colors colors) {
  if (colors == Colors::kGrey) return images::map_grey;
  if (colors == Colors::kSequential) return images::color_map("viridis");
  return [](float place) { return images::map_diverging(2.0f * place - 1.0f, 1.0f); };
}

DisplayPass::DisplayPass() {
  for (const Colors colors : {Colors::kGrey, Colors::kDiverging, Colors::kSequential})
    scales_.emplace(colors, upload_scale(colors));
}

void DisplayPass::clear_window(const glm::ivec2& size, const glm::vec3& color) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, size.x, size.y);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(color.x, color.y, color.z, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

images::Image DisplayPass::read_window(const glm::ivec2& corner, const glm::ivec2& size) {
  images::Image image(size.x, size.y, 3);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  for (int y = 0; y < size.y; ++y)
    glReadPixels(corner.x, corner.y + size.y - 1 - y, size.x, 1, GL_RGB, GL_FLOAT, image.at(0, y));
  return image;
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
  shown.values->bind(0);
  if (!is_picture) {
    (shown.less ? shown.less : shown.values)->bind(1);
    scales_.at(shown.colors).bind(2);
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

ResolvePass::ResolvePass(ResolveRule rule, int width, int height)
    : rule_(rule),
      targets_{ImageTarget("resolved visibility", GL_RGBA32F, width, height),
               ImageTarget("resolved visibility", GL_RGBA32F, width, height)} {
  targets_[newest_].clear(glm::vec4(0.0f));
}

void ResolvePass::add(ShaderLibrary& shaders, const scene::Scene& scene, const ResolvedFrame& frame) {
  const scene::Camera& before = before_.value_or(frame.camera);
  const double aspect = static_cast<double>(frame.gbuffer.width()) / frame.gbuffer.height();
  gl::Program& program = shaders.fullscreen("resolve.frag");
  program.set("clip_now", clip_from_world(frame.camera, scene.bounds(), aspect));
  program.set("clip_before", clip_from_world(before, scene.bounds(), aspect));
  program.set("depth_before", make_depth_plane(before));
  program.set("least_weight", rule_.least_weight);
  program.set("clamps", rule_.clamps ? 1 : 0);
  targets_[1 - newest_].bind();
  frame.gbuffer.bind();
  frame.visibility.bind(kAddedUnit);
  texture().bind(kHistoryUnit);
  program.use();
  gl::FullscreenTriangle().draw();
  newest_ = 1 - newest_;
  before_ = frame.camera;
}

}  // namespace shadowbench::render
