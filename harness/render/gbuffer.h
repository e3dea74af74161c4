#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "filters/depth_map.h"
#include "filters/receiver.h"
#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/render/bias.h"
#include "harness/render/geometry.h"
#include "harness/render/shader_library.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"

namespace shadowbench::render {

/// A light as the lookup sees it: where its map lies, how large it is, and how receivers are biased.
struct LightSetup {
  scene::LightFrustum frustum;
  double light_size = 0.0;  ///< see scene::light_size()
  Bias bias;
  std::uint32_t seed = 0;         ///< of the run: random rotations
  filters::RangeRule range = {};  ///< what becomes of receivers that the map does not hold
  std::uint32_t frame = 0;        ///< of those that are accumulated
};

/// The layers of a light's map, each as the lookup sees it: one, or those that share the receivers.
struct LightLayers : std::vector<LightSetup> {
  using std::vector<LightSetup>::vector;
  LightLayers(LightSetup only) : std::vector<LightSetup>{std::move(only)} {}
};

/// The setup of a light, or of a layer, whose map has this frustum.
LightSetup make_light_setup(const scene::LightFrustum& frustum, const scene::Light& light, const Bias& bias,
                            std::uint32_t seed, const filters::RangeRule& range = {});

/// Sets the cone of a light that stands in the scene: a program with the define PERSPECTIVE_LIGHT.
void set_beam(gl::Program& program, const scene::Beam& beam);

/// Sets the uniforms of lib/light.glsl.
void set_light(gl::Program& program, const LightSetup& light);

/// Sets those of them that say where a point lies in the map.
void set_shape(gl::Program& program, const scene::LightFrustum& frustum);

/// The defines that say how it lies there.
Defines shape_defines(const scene::LightFrustum& frustum);

/// The define for a light that stands in the scene.
inline const Defines::value_type kPerspectiveLight = {"PERSPECTIVE_LIGHT", "1"};

/// What prepare_receivers.frag needs for this light; nothing for an orthographic map with the right range rule.
Defines range_defines(const LightSetup& light);

/// What programs that look receivers up need for this light; nothing for an orthographic map and the default bias.
Defines receiver_defines(const LightSetup& light);

class GBuffer;

/// Where a view's receivers lie in one light's map, or in a layer of it, as lib/receiver.glsl reads it: all that
/// lookups need and that does not depend on their filters, two RGBA32F texels per pixel.
class ReceiverBuffer {
 public:
  /// Draws it. `prepare` is prepare_receivers.frag with the light's range_defines().
  ReceiverBuffer(gl::Program& prepare, const GBuffer& gbuffer, const LightSetup& light);

  /// Whether it holds what it would for this light. Bias that filters apply themselves does not count.
  bool is_of(const LightSetup& light) const;

  void bind() const;

  /// Of a map with layers: depth 0 where this layer serves a receiver, and 1 elsewhere.
  const gl::Texture& mask() const { return layer_->mask; }

 private:
  LightSetup light_;
  gl::Texture places_;
  gl::Texture planes_;

  struct Layer {
    gl::Texture shares;
    gl::Texture mask;
  };
  std::optional<Layer> layer_;  ///< only where the light's map has layers
};

/// Layers of lights' maps for which a view keeps its receivers.
inline constexpr std::size_t kKeptReceiverMaps = 32;

/// A part of a larger picture: its lower left pixel there, and the size of the whole; pixels.
struct PictureWindow {
  glm::ivec2 corner;
  glm::ivec2 whole;
};

/// What a camera sees, drawn once per view; every filter and the truth use the same receiver points.
class GBuffer {
 public:
  GBuffer(int width, int height);

  /// Draws the scene; near and far follow its bounds. `jitter` moves the picture to the right and up, in pixels. With a
  /// window only that part of the picture is drawn.
  void draw(ShaderLibrary& shaders, const Geometry& geometry, const scene::Scene& scene, const scene::Camera& camera,
            const glm::dvec2& jitter = glm::dvec2(0.0), const std::optional<PictureWindow>& window = std::nullopt);

  /// Replaces positions and geometric normals by those given, four floats a pixel as in position() and normal(), row 0
  /// at the bottom. Shading normals and colours stay undefined.
  void upload(std::span<const float> positions, std::span<const float> normals) {
    receivers_.clear();
    position_.upload_floats(positions, 4);
    normal_.upload_floats(normals, 4);
  }

  /// Where the receivers lie in a light's map; drawn when it is first asked for, and kept for the
  /// last kKeptReceiverMaps.
  const ReceiverBuffer& receivers(ShaderLibrary& shaders, const LightSetup& light) const;

  /// Frees what receivers() keeps: 32 bytes for each pixel and light.
  void forget_receivers() { receivers_.clear(); }

  /// Binds the textures to the units that lib/gbuffer.glsl and shade.frag name.
  void bind() const;

  int width() const { return position_.width(); }
  int height() const { return position_.height(); }

  const gl::Texture& position() const { return position_; }  ///< RGBA32F: world position, view depth (0: nothing)
  const gl::Texture& normal() const { return normal_; }      ///< RGBA32F: geometric normal
  const gl::Texture& shading_normal() const { return shading_normal_; }  ///< RGBA16F
  const gl::Texture& albedo() const { return albedo_; }                  ///< RGBA16F

 private:
  gl::Texture position_;
  gl::Texture normal_;
  gl::Texture shading_normal_;
  gl::Texture albedo_;
  gl::Texture depth_;
  gl::Framebuffer framebuffer_{"g-buffer"};
  mutable std::deque<ReceiverBuffer> receivers_;
};

/// Turns clip z around: w - z. It is computed in double, since a float projection has already lost the precision that a
/// reversed depth would keep.
glm::dmat4 reverse_depth(glm::dmat4 clip);

/// The matrix from world to clip space of a camera that looks at these bounds; depth is one at the near plane and zero
/// at the far one, so that a float resolves it as well far away. `shift` moves what it sees to the right and up, in
/// widths and heights of the picture.
glm::mat4 clip_from_world(const scene::Camera& camera, const scene::Bounds& bounds, double aspect,
                          const glm::dvec2& shift = glm::dvec2(0.0));

/// Sets the state that drawing opaque geometry needs; both faces are drawn.
void set_geometry_state();

/// The number of receivers: pixels that face the light. Those beyond the map's reach are lit, and are scored like all
/// others. Layers of the map share them, and change nothing.
std::int64_t count_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightLayers& light);

/// Reads back, for the models, the receivers that the lookup pass asks the filter about, bit for bit: those that
/// count_receivers() counts, that this layer of the map serves, and that the map reaches under the light's range rule.
std::vector<filters::Receiver> read_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

/// The share of each receiver that a layer of the map serves, rows top to bottom; 0 where there is no receiver.
std::vector<float> read_layer_shares(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& layer);

}  // namespace shadowbench::render
