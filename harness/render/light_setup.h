#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "filters/depth_map.h"
#include "harness/gl/program.h"
#include "harness/render/bias/bias_rule.h"
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

}  // namespace shadowbench::render
