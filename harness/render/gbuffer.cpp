#include "harness/render/gbuffer.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace shadowbench::render {
namespace {

struct DepthRange {
  double near;
  double far;
};

DepthRange depth_range(const scene::Camera& camera, const scene::Bounds& bounds) {
  double nearest = std::numeric_limits<double>::max(), farthest = std::numeric_limits<double>::lowest();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p((corner & 1) ? bounds.max.x : bounds.min.x, (corner & 2) ? bounds.max.y : bounds.min.y,
                       (corner & 4) ? bounds.max.z : bounds.min.z);
    const double along = glm::dot(p - glm::dvec3(camera.position_ws), glm::dvec3(camera.forward_ws));
    nearest = std::min(nearest, along);
    farthest = std::max(farthest, along);
  }
  const double margin = 0.01 * std::max(farthest - nearest, 1e-6 * std::abs(farthest));
  const double far = std::max(farthest + margin, 1e-30);
  // A perspective near plane at or behind the camera does not exist; a ten-thousandth keeps single precision usable.
  const bool perspective = camera.orthographic_height_m <= 0.0f;
  return {perspective ? std::max(nearest - margin, 1e-4 * far) : nearest - margin, far};
}

}  // namespace

glm::mat4 clip_from_world(const scene::Camera& camera, const scene::Bounds& bounds, double aspect) {
  const DepthRange range = depth_range(camera, bounds);
  const glm::dvec3 eye(camera.position_ws);
  const glm::dmat4 view = glm::lookAtRH(eye, eye + glm::dvec3(camera.forward_ws), glm::dvec3(camera.up_ws));
  const double half = 0.5 * static_cast<double>(camera.orthographic_height_m);
  const glm::dmat4 projection =
      half > 0.0 ? glm::orthoRH_ZO(-half * aspect, half * aspect, -half, half, range.near, range.far)
                 : glm::perspectiveRH_ZO(static_cast<double>(camera.vertical_fov_rad), aspect, range.near, range.far);
  return glm::mat4(projection * view);
}

void set_geometry_state() {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

GBuffer::GBuffer(int width, int height)
    : position_("g-buffer position", GL_RGBA32F, width, height),
      normal_("g-buffer normal", GL_RGBA32F, width, height),
      shading_normal_("g-buffer shading normal", GL_RGBA16F, width, height),
      albedo_("g-buffer albedo", GL_RGBA16F, width, height),
      depth_("g-buffer depth", GL_DEPTH_COMPONENT32F, width, height) {
  framebuffer_.attach_color(0, position_);
  framebuffer_.attach_color(1, normal_);
  framebuffer_.attach_color(2, shading_normal_);
  framebuffer_.attach_color(3, albedo_);
  framebuffer_.attach_depth(depth_);
}

void GBuffer::draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::Scene& scene,
                   const scene::Camera& camera) {
  receivers_.clear();
  framebuffer_.bind();
  set_geometry_state();
  for (int i = 0; i < 4; ++i) framebuffer_.clear_color(i, glm::vec4(0.0f));
  framebuffer_.clear_depth(1.0f);
  const double aspect = static_cast<double>(width()) / height();
  const glm::mat4 matrix = clip_from_world(camera, scene.bounds(), aspect);
  geometry.draw(shaders, "gbuffer", DrawSet::kAll, [&](gl::Program& program) {
    program.set("clip_from_world", matrix);
    program.set("camera_position_ws", camera.position_ws);
    program.set("camera_forward_ws", camera.forward_ws);
    program.set("orthographic", camera.orthographic_height_m > 0.0f ? 1 : 0);
  });
}

const ReceiverBuffer& GBuffer::receivers(ShaderLibrary& shaders, const LightSetup& light) const {
  const auto found = std::ranges::find_if(receivers_, [&](const ReceiverBuffer& each) { return each.is_of(light); });
  if (found != receivers_.end()) return *found;
  if (receivers_.size() == kKeptReceiverMaps) receivers_.pop_front();
  return receivers_.emplace_back(shaders.fullscreen("prepare_receivers.frag", range_defines(light)), *this, light);
}

void GBuffer::bind() const {
  GLuint unit = 8;
  for (const gl::Texture* texture : {&position_, &normal_, &shading_normal_, &albedo_}) {
    gl::Sampler::unbind(unit);
    texture->bind(unit++);
  }
}

}  // namespace shadowbench::render
