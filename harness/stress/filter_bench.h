#pragma once

#include <optional>
#include <vector>

#include "harness/render/filter_passes.h"
#include "harness/render/image_target.h"
#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// Sizes of what a filter reads and writes.
struct BenchSize {
  int map = 0;  ///< texels per side
  int width = 0;
  int height = 1;
  bool operator==(const BenchSize&) const = default;
};

/// One filter with the shadow map that it reads, the G-buffer of its receivers and the picture that it writes.
class FilterBench {
 public:
  /// Requires inputs.renderer, which outlives the bench. Nothing is compiled or allocated before resize().
  FilterBench(const AxisInputs& inputs, filters::FilterRequest request);

  /// Allocates map, G-buffer and picture; keeps those that have this size.
  /// Throws Error as render::ShadowMap.
  void resize(const BenchSize& size);

  render::ShadowMap& map() { return surfaces_->map; }
  render::GBuffer& gbuffer() { return surfaces_->gbuffer; }
  render::ShaderLibrary& shaders() { return shaders_; }
  const filters::FilterRequest& request() const { return request_; }

  /// Puts receivers into the G-buffer, row by row, all with one normal.
  void upload_receivers(const std::vector<glm::vec3>& positions_ws, const glm::vec3& normal_ws);

  /// Runs the filter's passes with these parameter values; compiles them first where that is needed. Gives the
  /// visibility of each receiver. Throws Error as render::FilterPasses.
  std::vector<float> look_up(const render::LightSetup& light, const filters::ParamValues& values);

  /// Counts the texels of the encoded map that overflowed. Call after look_up().
  std::int64_t count_broken_texels();

 private:
  struct Surfaces {
    explicit Surfaces(const BenchSize& size)
        : map(size.map),
          gbuffer(size.width, size.height),
          target("stress visibility", GL_R32F, size.width, size.height) {}
    render::ShadowMap map;
    render::GBuffer gbuffer;
    render::ImageTarget target;
  };

  render::ShaderLibrary& shaders_;
  filters::FilterRequest request_;
  BenchSize size_;
  std::optional<Surfaces> surfaces_;
  std::optional<render::FilterPasses> passes_;
};

/// Makes the frustum of a light that looks along z over a map so wide; receivers' (x, y, z) are u, v and depth.
scene::LightFrustum make_axis_frustum(double width_ws, int map_texels);

}  // namespace shadowbench::stress
