#pragma once

#include <cstdint>
#include <vector>

#include "filters/receiver.h"
#include "harness/render/gbuffer.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {

/// Counts the pixels that count: those that face the light. Where the map does not reach they are lit, and are scored
/// like all others.
std::int64_t count_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

/// Reads the receivers that the lookup pass asks the filter about, bit for bit, for the models: of those that
/// count_receivers counts, the ones that the map reaches under the light's range rule.
std::vector<filters::Receiver> read_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

}  // namespace shadowbench::render
