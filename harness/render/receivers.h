#pragma once

#include <cstdint>
#include <vector>

#include "filters/receiver.h"
#include "harness/render/gbuffer.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {

/// The number of receivers: pixels that face the light. Those beyond the map's reach are lit, and are scored like all
/// others. Layers of the map share them, and change nothing.
std::int64_t count_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightLayers& light);

/// Reads back, for the models, the receivers that the lookup pass asks the filter about, bit for bit: those that
/// count_receivers() counts, that this layer of the map serves, and that the map reaches under the light's range rule.
std::vector<filters::Receiver> read_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

/// The share of each receiver that a layer of the map serves, rows top to bottom; 0 where there is no receiver.
std::vector<float> read_layer_shares(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& layer);

}  // namespace shadowbench::render
