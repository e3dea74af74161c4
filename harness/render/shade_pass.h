#pragma once

#include "harness/render/gbuffer.h"
#include "harness/render/image_target.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// Shades a G-buffer with a visibility image (R32F, the same size): Blinn-Phong whose ambient part is never shadowed.
/// Returns linear RGB, rows top to bottom.
images::Image shade(ShaderLibrary& shaders, const GBuffer& gbuffer, const gl::Texture& visibility,
                    const scene::Scene& scene, const scene::Camera& camera);

}  // namespace shadowbench::render
