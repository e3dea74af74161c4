#pragma once

#include "filters/map_range.h"
#include "harness/render/gbuffer.h"
#include "harness/render/image_target.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// Shades a G-buffer with a visibility image (R32F, the same size): Blinn-Phong whose ambient part is never shadowed.
/// Returns linear RGB, rows top to bottom. Without the range rule's behind test a lamp's cone and cookie are mirrored
/// through it.
images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera, const filters::RangeRule& range = {});

}  // namespace shadowbench::render
