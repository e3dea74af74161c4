#include "harness/render/shade_pass.h"

#include <cmath>

#include "harness/gl/fullscreen.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kVisibilityUnit = 4;  // of shade.frag
constexpr GLuint kCookieUnit = 13;     // of lib/cookie.glsl

Defines shade_defines(const scene::Light& light, const filters::RangeRule& range) {
  Defines defines;
  if (scene::find_beam(light)) defines.push_back(kPerspectiveLight);
  if (scene::find_beam(light) && !range.behind_test) defines.emplace_back("NO_BEHIND_TEST", "1");
  if (scene::find_cookie(light)) defines.emplace_back("HAS_COOKIE", "1");
  return defines;
}

gl::Texture upload_cookie(const scene::Texture& picture) {
  gl::Texture cookie("cookie " + picture.name, GL_SRGB8_ALPHA8, picture.width, picture.height);
  cookie.upload_bytes(picture.rgba, 4);
  cookie.set_filter(GL_LINEAR, GL_LINEAR);
  return cookie;
}

void set_cookie(gl::Program& program, const gl::Texture& cookie, const scene::Beam& beam) {
  const glm::dmat3 axes = glm::transpose(scene::light_rotation(beam.axis_ws));
  program.set("light_right_ws", glm::vec3(axes[0]));
  program.set("light_up_ws", glm::vec3(axes[1]));
  program.set("cookie_tangent", static_cast<float>(std::tan(std::acos(beam.cos_outer))));
  gl::Sampler::unbind(kCookieUnit);
  cookie.bind(kCookieUnit);
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
  gl::Sampler::unbind(kVisibilityUnit);
  visibility.bind(kVisibilityUnit);
  std::optional<gl::Texture> cookie;
  if (const scene::Texture* picture = scene::find_cookie(scene.light)) {
    cookie = upload_cookie(*picture);
    set_cookie(program, *cookie, *beam);
  }
  program.use();
  gl::FullscreenTriangle().draw();
}

images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera, const filters::RangeRule& range) {
  ImageTarget target("picture", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  shade_into(target, shaders, {gbuffer, visibility, scene, camera, range}, {0, gbuffer.width()});
  return read_image(target.texture(), 3);
}

}  // namespace shadowbench::render
