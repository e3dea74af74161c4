#include "harness/render/shadow_map.h"

#include "harness/gl/fullscreen.h"
#include "harness/render/gbuffer.h"

namespace shadowbench::render {
namespace {

/// Draws casters as the light sees them; both faces, but front faces of cullable ones where the bias says so.
void draw_casters(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum, const MapBias& bias,
                  gl::Framebuffer& framebuffer, const Defines& defines) {
  framebuffer.bind();
  set_geometry_state();
  framebuffer.clear_depth(1.0f);
  if (bias.polygon_factor != 0.0 || bias.polygon_units != 0.0) {
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(static_cast<float>(bias.polygon_factor), static_cast<float>(bias.polygon_units));
  }
  const auto prepare = [&](gl::Program& program) { program.set("clip_from_world", frustum.clip_from_world); };
  if (bias.cull_front) {
    geometry.draw(shaders, "depth", DrawSet::kUncullableCasters, prepare, defines);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    geometry.draw(shaders, "depth", DrawSet::kCullableCasters, prepare, defines);
  } else {
    geometry.draw(shaders, "depth", DrawSet::kCasters, prepare, defines);
  }
  set_geometry_state();
}

}  // namespace

ShadowMap::Layer::Layer(const char* label, int size)
    : depth(label, GL_DEPTH_COMPONENT32F, size, size), framebuffer(label) {
  framebuffer.attach_depth(depth);
}

ShadowMap::ShadowMap(int size) : map_("shadow map", size) {
  for (gl::Sampler* sampler : {&plain_, &compare_linear_, &compare_nearest_}) {
    sampler->set_filter(GL_NEAREST, GL_NEAREST);
    sampler->set_wrap(GL_CLAMP_TO_BORDER);
    sampler->set_border(glm::vec4(1.0f));  // depth 1: nothing in the way
  }
  compare_linear_.set_filter(GL_LINEAR, GL_LINEAR);
  compare_linear_.set_compare(GL_LEQUAL);
  compare_nearest_.set_compare(GL_LEQUAL);
}

void ShadowMap::draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum, const MapBias& bias) {
  if (bias.midpoint) {
    draw_midpoint(shaders, geometry, frustum, bias);
  } else {
    draw_casters(shaders, geometry, frustum, bias, map_.framebuffer, {});
  }
}

/// Woo 1992, The Shadow Depth Map Revisited, Graphics Gems III: the map lies between the first and the second surface, so
/// that neither shadows itself. Where there is no second one it counts as depth 1.
void ShadowMap::draw_midpoint(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum,
                              const MapBias& bias) {
  if (surfaces_.empty()) {
    surfaces_.emplace_back("first surface", size());
    surfaces_.emplace_back("second surface", size());
  }
  for (gl::Texture* texture : {&surfaces_[0].depth, &surfaces_[1].depth}) texture->set_filter(GL_NEAREST, GL_NEAREST);
  draw_casters(shaders, geometry, frustum, bias, surfaces_[0].framebuffer, {});
  gl::Sampler::unbind(0);
  surfaces_[0].depth.bind(0);
  draw_casters(shaders, geometry, frustum, bias, surfaces_[1].framebuffer, {{"BEHIND_FIRST", "1"}});
  gl::Sampler::unbind(1);
  surfaces_[1].depth.bind(1);
  map_.framebuffer.bind();
  shaders.fullscreen("midpoint.frag").use();
  gl::FullscreenTriangle().draw_depth();
}

void ShadowMap::bind() const {
  const gl::Sampler* samplers[] = {&plain_, &compare_linear_, &compare_nearest_};
  for (GLuint unit = 0; unit < 3; ++unit) {
    map_.depth.bind(unit);
    samplers[unit]->bind(unit);
  }
}

filters::DepthMap ShadowMap::read() const { return {size(), map_.depth.read_floats(1)}; }

}  // namespace shadowbench::render
