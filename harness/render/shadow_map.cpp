#include "harness/render/shadow_map.h"

#include "harness/render/gbuffer.h"

namespace shadowbench::render {

ShadowMap::ShadowMap(int size) : depth_("shadow map", GL_DEPTH_COMPONENT32F, size, size) {
  framebuffer_.attach_depth(depth_);
  for (gl::Sampler* sampler : {&plain_, &compare_linear_, &compare_nearest_}) {
    sampler->set_filter(GL_NEAREST, GL_NEAREST);
    sampler->set_wrap(GL_CLAMP_TO_BORDER);
    sampler->set_border(glm::vec4(1.0f));  // depth 1: nothing in the way
  }
  compare_linear_.set_filter(GL_LINEAR, GL_LINEAR);
  compare_linear_.set_compare(GL_LEQUAL);
  compare_nearest_.set_compare(GL_LEQUAL);
}

void ShadowMap::draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum) {
  framebuffer_.bind();
  set_geometry_state();
  framebuffer_.clear_depth(1.0f);
  geometry.draw(shaders, "depth", DrawSet::kCasters,
                [&](gl::Program& program) { program.set("clip_from_world", frustum.clip_from_world); });
}

void ShadowMap::bind() const {
  const gl::Sampler* samplers[] = {&plain_, &compare_linear_, &compare_nearest_};
  for (GLuint unit = 0; unit < 3; ++unit) {
    depth_.bind(unit);
    samplers[unit]->bind(unit);
  }
}

filters::DepthMap ShadowMap::read() const { return {size(), depth_.read_floats(1)}; }

}  // namespace shadowbench::render
