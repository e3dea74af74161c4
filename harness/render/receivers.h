#pragma once

#include <cstdint>
#include <vector>

#include "filters/receiver.h"
#include "harness/render/gbuffer.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {

/// The number of receivers: pixels that face the light. Those beyond the map's reach are lit, and are scored like all
/// others.
std::int64_t count_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

/// Reads back, for the models, the receivers that the lookup pass asks the filter about, bit for bit: those that
/// count_receivers() counts and that the map reaches under the light's range rule.
std::vector<filters::Receiver> read_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

}  // namespace shadowbench::render
