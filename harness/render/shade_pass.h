#pragma once

#include "filters/map_range.h"
#include "harness/render/gbuffer.h"
#include "harness/render/image_target.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// Shades a G-buffer with a visibility image (R32F, the same size) into `target` (RGBA32F, likewise): Blinn-Phong whose
/// ambient part is never shadowed; linear RGB. Only in `columns`, from the first up to the second. Without the range
/// rule's behind test a lamp's cone and cookie are mirrored through it.
void shade_into(ImageTarget& target, ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                const scene::Scene& scene, const scene::Camera& camera, const filters::RangeRule& range,
                const glm::ivec2& columns);

/// The same, read back: rows top to bottom.
images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera, const filters::RangeRule& range = {});

}  // namespace shadowbench::render
