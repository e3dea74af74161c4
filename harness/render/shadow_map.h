#pragma once

#include <cstdint>
#include <vector>

#include "filters/model.h"
#include "harness/gl/objects.h"
#include "harness/render/bias.h"
#include "harness/render/geometry.h"
#include "harness/scene/light_fit.h"

namespace shadowbench::render {

/// The depth map of one light: 32-bit float, depth in [0,1], 0 near.
class ShadowMap {
 public:
  /// Throws Error(kUsage) when the GL cannot give this size.
  explicit ShadowMap(int size);

  /// Draws the casters as the light sees them; by default nothing is culled, nothing is biased.
  /// Cost: one pass over the casters, two and a full-screen pass for a midpoint map.
  void draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum, const MapBias& bias = {});

  /// Binds the map to the three units of lib/map_access.glsl that read depth.
  void bind() const;

  /// Reads the map back for the models.
  filters::DepthMap read() const;

  const gl::Texture& texture() const { return map_.depth; }
  int size() const { return map_.depth.width(); }
  std::int64_t bytes() const { return static_cast<std::int64_t>(map_.depth.bytes()); }

 private:
  /// A depth texture that is drawn into.
  struct Layer {
    Layer(const char* label, int size);
    gl::Texture depth;
    gl::Framebuffer framebuffer;
  };

  Layer map_;
  std::vector<Layer> surfaces_;  ///< first and second, only for midpoint maps
  void draw_midpoint(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum, const MapBias& bias);

  gl::Sampler plain_{"depth, plain"};
  gl::Sampler compare_linear_{"depth, compared, 2x2"};
  gl::Sampler compare_nearest_{"depth, compared, nearest"};
};

}  // namespace shadowbench::render
