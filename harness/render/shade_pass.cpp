#include "harness/render/shade_pass.h"

#include "harness/gl/fullscreen.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kVisibilityUnit = 4;  // of shade.frag

}  // namespace

images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera) {
  ImageTarget target("picture", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  const std::optional<scene::Beam> beam = scene::find_beam(scene.light);
  gl::Program& program = shaders.fullscreen("shade.frag", beam ? Defines{kPerspectiveLight} : Defines{});
  program.set("camera_position_ws", camera.position_ws);
  program.set("camera_forward_ws", camera.forward_ws);
  program.set("orthographic", camera.orthographic_height_m > 0.0f ? 1 : 0);
  if (beam)
    set_beam(program, *beam);
  else
    program.set("light_direction_ws", -scene::to_light(scene.light, {}));
  program.set("light_radiance", scene.light.color * scene.light.intensity);
  program.set("background", scene.background);
  target.bind();
  gbuffer.bind();
  gl::Sampler::unbind(kVisibilityUnit);
  visibility.bind(kVisibilityUnit);
  program.use();
  gl::FullscreenTriangle().draw();
  return read_image(target.texture(), 3);
}

}  // namespace shadowbench::render
