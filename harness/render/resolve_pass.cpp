#include "harness/render/resolve_pass.h"

#include "harness/gl/fullscreen.h"

namespace shadowbench::render {
namespace {

constexpr GLuint kAddedUnit = 4, kHistoryUnit = 12;  // of resolve.frag

/// Gives the distance of a point from a camera along its axis, as gbuffer.frag has it.
glm::vec4 make_depth_plane(const scene::Camera& camera) {
  return glm::vec4(camera.forward_ws, -glm::dot(camera.forward_ws, camera.position_ws));
}

}  // namespace

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
  for (const GLuint unit : {kAddedUnit, kHistoryUnit}) gl::Sampler::unbind(unit);
  frame.visibility.bind(kAddedUnit);
  texture().bind(kHistoryUnit);
  program.use();
  gl::FullscreenTriangle().draw();
  newest_ = 1 - newest_;
  before_ = frame.camera;
}

}  // namespace shadowbench::render
