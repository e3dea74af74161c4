#pragma once

#include <cstdint>

#include "filters/model.h"
#include "harness/gl/objects.h"
#include "harness/render/geometry.h"
#include "harness/scene/light_fit.h"

namespace shadowbench::render {

/// The depth map of one light: 32-bit float, depth in [0,1], 0 near.
class ShadowMap {
 public:
  /// Throws Error(kUsage) when the GL cannot give this size.
  explicit ShadowMap(int size);

  /// Draws the casters as the light sees them; nothing is culled, nothing is biased.
  void draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum);

  /// Binds the map to the three units of lib/map_access.glsl that read depth.
  void bind() const;

  /// Reads the map back for the models.
  filters::DepthMap read() const;

  const gl::Texture& texture() const { return depth_; }
  int size() const { return depth_.width(); }
  std::int64_t bytes() const { return static_cast<std::int64_t>(depth_.bytes()); }

 private:
  gl::Texture depth_;
  gl::Framebuffer framebuffer_{"shadow map"};
  gl::Sampler plain_{"depth, plain"};
  gl::Sampler compare_linear_{"depth, compared, 2x2"};
  gl::Sampler compare_nearest_{"depth, compared, nearest"};
};

}  // namespace shadowbench::render
