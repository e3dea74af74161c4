#pragma once

#include "filters/depth_map.h"
#include "harness/render/gbuffer.h"
#include "harness/render/image_target.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// The share of the ambient light that an upright surface gets; one that faces up gets all.
inline constexpr float kAmbientAtSide = 0.75f;

/// What a camera sees, to be shaded.
struct ShadedView {
  const GBuffer& gbuffer;
  const gl::Texture& visibility;  ///< R32F, of the G-buffer's size
  const scene::Scene& scene;
  const scene::Camera& camera;
  filters::RangeRule range = {};  ///< without its behind test a lamp's cone and cookie are mirrored through it
};

/// Shades a view into `target` (RGBA32F, of its size): Blinn-Phong whose ambient part is never shadowed; linear RGB.
/// Only in `columns`, from the first up to the second.
void shade_into(ImageTarget& target, ShaderLibrary& shaders, const ShadedView& view, const glm::ivec2& columns);

/// The same, read back: rows top to bottom.
images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera, const filters::RangeRule& range = {});

}  // namespace shadowbench::render
