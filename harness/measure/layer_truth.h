#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/render/gbuffer.h"
#include "reference/truth/cached_tracer.h"

namespace shadowbench::measure {

/// A layer of a light's map, as rays follow a kernel through it, and pixels fall in it.
struct TracedLayer {
  scene::LightFrustum frustum;
  std::vector<float> shares = {};  ///< of each pixel that this layer serves, rows top to bottom; empty: it serves all
  std::string content = {};        ///< a name for the shares, by which a cache knows them
};

/// What traces the receivers through the layer of this index.
using LayerTrace =
    std::function<truth::TracedVisibility(const truth::ReceiverImage&, const truth::MapGrid&, std::size_t)>;

/// The layers of a light's map for the receivers of a view; no bias plays a part.
std::vector<TracedLayer> list_traced_layers(render::ShaderLibrary& shaders, const render::GBuffer& gbuffer,
                                            const render::LightLayers& light);

/// The layer that serves most of a pixel.
std::size_t choose_layer(const std::vector<TracedLayer>& layers, std::size_t pixel);

/// Traces receivers through the grid of the layer that serves them; where several share a pixel, their traces are added
/// by their shares, and agree where all rays of all of them do.
truth::TracedVisibility trace_layers(const std::vector<TracedLayer>& layers, const truth::ReceiverImage& receivers,
                                     const LayerTrace& trace);

}  // namespace shadowbench::measure
