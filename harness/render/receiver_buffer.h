#pragma once

#include <optional>

#include "harness/gl/objects.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {

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

}  // namespace shadowbench::render
