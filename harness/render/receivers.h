#pragma once

#include <cstdint>
#include <vector>

#include "filters/receiver.h"
#include "harness/render/gbuffer.h"
#include "harness/render/light_setup.h"

namespace shadowbench::render {

/// Counts the pixels that filters are asked about: those that face the light and lie before the map's far plane.
std::int64_t count_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

/// Reads the receivers that the lookup pass sees, bit for bit, for the models: those that count_receivers counts.
std::vector<filters::Receiver> read_receivers(ShaderLibrary& shaders, const GBuffer& gbuffer, const LightSetup& light);

}  // namespace shadowbench::render
