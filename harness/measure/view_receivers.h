#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/render/gbuffer.h"
#include "harness/scene/lights/light.h"
#include "reference/truth/cached_tracer.h"
#include "reference/truth/visibility.h"
#include "report/images/image.h"

namespace shadowbench::measure {

/// The receivers of a view, for the truth; rows run top to bottom as in every image of a report.
struct ViewReceivers {
  truth::ReceiverImage image;
  std::vector<std::uint8_t> is_surface;  ///< 0: background

  bool any_counts() const;

  /// Visibility as the lookup pass writes it: surfaces turned away from the light are dark, the background is lit.
  images::Image to_image(const std::vector<float>& visibility) const;

  /// 1 where a pixel counts: a surface that faces the light.
  std::vector<std::uint8_t> mask() const;
};

/// Whether two receivers close by count, and lie on one surface, which is nearly flat between them.
bool lie_on_one_surface(const truth::ReceiverPoint& a, const truth::ReceiverPoint& b);

/// The surfaces that a view's pixels show, as a G-buffer holds them: four channels, rows top to bottom.
struct ViewSurfaces {
  images::Image positions;  ///< world space; the fourth channel is 0 on the background
  images::Image normals;    ///< geometric, flipped to the viewer
};

ViewSurfaces read_view_surfaces(const render::GBuffer& gbuffer);

/// The receivers of a view; those count that face the light. Cost: 0.03 s for half a million pixels.
ViewReceivers make_view_receivers(const ViewSurfaces& surfaces, const scene::Light& light);

/// Reads the receivers that a G-buffer holds; those count that face the light.
ViewReceivers read_view_receivers(const render::GBuffer& gbuffer, const scene::Light& light);

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
