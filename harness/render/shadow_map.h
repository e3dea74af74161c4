#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "filters/depth_map.h"
#include "harness/gl/objects.h"
#include "harness/render/bias.h"
#include "harness/render/geometry.h"
#include "harness/scene/lights/light_fit.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// The wrap mode of samplers that reads outside a map as `border` says, e.g. GL_CLAMP_TO_BORDER.
GLenum wrap_mode(filters::Border border);

/// Names map settings as records do: "d32f", "d16 reversed", "d24 perspective 1000".
std::string describe_map(const MapSettings& settings);

/// The largest step between depths of 0 .. `farthest` that a map can store. Depths that differ by less may be stored as
/// one.
double find_coarsest_step(const MapSettings& settings, double farthest = 1.0);

/// The defines that lib/depth_curve.glsl needs; none for a map that holds linear depth, 0 near. Curves that differ in
/// nothing but `far_over_near` share a program; whoever draws with it sets that.
Defines curve_defines(const filters::DepthCurve& curve);

/// Checks that the GL stores the depth format that it was asked for; `bits` is GL_TEXTURE_DEPTH_SIZE of the texture.
/// Throws Error(kUsage) if not: another precision than the one asked for would be studied.
void require_depth_bits(GLenum format, int bits);

/// The depth map of one light; depth in [0,1], 0 near, whatever the format and the curve it is stored by. It has one
/// layer or, where cascades or the faces of a cube share the receivers, several of one size. A perspective map of a
/// light that stands in the scene holds the depth of its projection, from draw() on.
class ShadowMap {
 public:
  /// Throws Error(kUsage) when the GL cannot give this size or format.
  explicit ShadowMap(int size, const MapSettings& settings = {}, int layers = 1);

  /// Chooses what lookups read outside; a new map has depth 1 there.
  void set_border(filters::Border border);

  /// Draws the casters as the light sees them, into the frustum's layer; by default nothing is culled, nothing is
  /// biased.
  /// Cost: one pass over the casters, two and a full-screen pass for a midpoint map.
  /// Requires linear depth where the bias has a polygon offset, which the GL adds to depth as it is drawn.
  /// Throws Error(kUsage) where the frustum's projection has a curve, and the map was to have another.
  void draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum,
            const MapBias& bias = {});

  /// Draws what the map holds into a multisampled target of the map's size and format: the same casters, or the
  /// map itself where it was uploaded, or where it holds no surface that could be drawn.
  void draw_samples(ShaderLibrary& shaders, ImageTarget& target, int layer) const;

  /// Replaces the first layer's contents by stored depths, row 0 at v = 0. Fixed-point formats clamp them. Requires
  /// size() * size() values.
  void upload(std::span<const float> stored);

  /// Binds a layer to the three units of lib/map_access.glsl that read depth, and tells the program that will read them
  /// how it is stored. Requires a program that was compiled with the curve_defines() of this map.
  void bind(gl::Program& reader, int layer = 0) const;

  /// Reads a layer back for the models, as it is stored.
  filters::DepthMap read(int layer = 0) const;

  /// Reads the map back as a picture, rows top to bottom: row 0 is v = 1; layers stand side by side. As it is stored;
  /// see settings().curve.
  images::Image read_picture() const;

  const gl::Texture& texture(int layer = 0) const { return layers_[static_cast<std::size_t>(layer)].texture(); }
  int size() const { return texture().width(); }
  int layers() const { return static_cast<int>(layers_.size()); }
  const MapSettings& settings() const { return settings_; }  ///< as it was drawn last
  std::int64_t bytes() const { return layers() * static_cast<std::int64_t>(texture().bytes()); }

 private:
  /// What draw() drew last.
  struct Drawn {
    Geometry geometry;
    scene::LightFrustum frustum;
    MapBias bias;
  };

  filters::DepthCurve wanted_;  ///< of depth that no projection has curved
  MapSettings settings_;
  std::vector<ImageTarget> layers_;
  std::vector<std::optional<Drawn>> drawn_;  ///< by layer; nothing where it was uploaded
  std::vector<ImageTarget> surfaces_;        ///< first and second, only for midpoint maps
  gl::Sampler plain_{"depth, plain"};
  gl::Sampler compare_linear_{"depth, compared, 2x2"};
  gl::Sampler compare_nearest_{"depth, compared, nearest"};
  filters::Border border_ = filters::Border::kBorder;

  /// Draws casters into a layer; both faces, but front faces of cullable ones where the bias says so.
  void draw_casters(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum,
                    const MapBias& bias, ImageTarget& target, Defines defines) const;
  void draw_midpoint(ShaderLibrary& shaders, const Geometry& geometry, const scene::LightFrustum& frustum,
                     const MapBias& bias);
  /// Draws the mean of the depths that units 0 and 1 hold.
  void draw_mean(ShaderLibrary& shaders, ImageTarget& target) const;
};

}  // namespace shadowbench::render
