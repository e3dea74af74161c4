#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "filters/kernel.h"
#include "filters/model.h"
#include "filters/receiver.h"
#include "harness/options/options.h"
#include "harness/render/gbuffer.h"
#include "harness/scene/complete.h"
#include "harness/scene/lights/light.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
#include "reference/truth/cached_tracer.h"
#include "reference/truth/visibility.h"
#include "report/images/image.h"
#include "report/records/records.h"

namespace shadowbench::measure {

struct MapFit;

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

/// The index of a receiver's pixel in a picture whose rows run from top to bottom; receivers count them from the
/// bottom.
inline std::size_t find_pixel(const filters::Receiver& receiver, int width, int height) {
  return static_cast<std::size_t>((height - 1 - receiver.pixel.y) * width + receiver.pixel.x);
}

/// Puts what a layer of the map makes of its share of a receiver into a pixel that is 1 before all layers.
inline void put_share(double& pixel, const filters::Receiver& receiver, double visibility) {
  if (receiver.layer_share == 1.0f)
    pixel = visibility;
  else
    pixel += static_cast<double>(receiver.layer_share) * (visibility - 1.0);
}

/// Calls `visit(i)` for every index below `count`, in parallel and in no order.
template <class Visit>
void visit_in_parallel(std::size_t count, const Visit& visit) {
  constexpr std::size_t kGrain = 1024;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) visit(i);
  });
}

/// What a filter's scalar model and its kernel make of a view; rows run from top to bottom. Visibility is 1 where there
/// is no receiver, and where the map does not reach.
struct ModelImages {
  std::vector<double> model;  ///< the filter in double precision; empty where it has no scalar model
  std::vector<double>
      closer;  ///< brute-force percentage-closer filter with the pixels' own kernels, where these differ
  /// Of the pixels' own kernels, where these differ, by layer of the map; empty otherwise.
  std::vector<std::vector<float>> disk_radii_texels;
  std::int64_t excused = 0;  ///< receivers where rounding decides which texel is read, or a comparison
};

/// A layer of a light's map, with the receivers of a view that it serves.
struct ModelLayer {
  filters::DepthMap map;
  std::vector<filters::Receiver> receivers;
};

/// What a model has to know of the view that receivers come from.
struct ModelView {
  int width = 0;
  int height = 0;
  std::uint32_t seed = 1;  ///< these as in ModelInput
  double plane_max_tangent = 0.0;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

  filters::ModelInput input(const filters::FilterRequest& request, const filters::DepthMap& map,
                            const filters::GlAccuracy& accuracy = {}) const {
    return {request.spec, request.values, map, accuracy, seed, plane_max_tangent};
  }
};

/// Evaluates a model for receivers that the GPU handed out, in parallel. Requires a filter that has a kernel or a
/// model.
ModelImages evaluate_model(const filters::FilterRequest& request, const std::vector<ModelLayer>& layers,
                           const ModelView& view);

/// The brute-force percentage-closer filter with one kernel for all pixels, in parallel; an image as those of a model.
std::vector<double> compare_kernel(const filters::Kernel& kernel, const std::vector<ModelLayer>& layers,
                                   const ModelView& view);

/// Where the pixels of a view fall in a light's map; rows top to bottom.
struct MapCoverage {
  /// Map texels under each pixel's footprint; 0 on a surface turned away from the light or outside the
  /// map, -1 on the background.
  images::Image density;
  std::vector<std::optional<double>> texels_per_pixel;  ///< median of each layer
  records::CoverageRecord record;                       ///< empty fields where no receiver in the map faces the light
};

/// Lays the pixels of a view out in the map. A pixel's footprint is the parallelogram that its sides cut out of its
/// receiver's tangent plane; its area along the light, over a texel's area, is the texels per pixel. `map_used` is the
/// share of the map's area under footprints, in cells of 1/512 of its side, or texels where it has fewer; a footprint
/// wider than 64 cells counts where its centre lies. `map_filled` is the share of the texels of `depth_map` that are
/// nearer than 1. A pixel falls in the layer that serves most of it; layers stand side by side, as in `depth_map`.
MapCoverage measure_coverage(const ViewReceivers& receivers, const scene::Camera& camera,
                             const std::vector<TracedLayer>& layers, const images::Image& depth_map);

/// Finds the width that a scene's light asks of a kernel, in a view and a map: the standard deviation along an axis, in
/// texels, of the kernel that blurs an edge as the light's penumbra does, of the median of the penumbrae in view. Each
/// counts by its width, as the pixels that lie in it do. Rounded to a hundredth of a texel. Empty where no edge of a
/// shadow is in view. Cost: a picture of one ray for each pixel, 240 pixels wide; no map is drawn.
std::optional<double> find_light_sigma(const scene::EdgeMeter& meter, const options::RunOptions& options,
                                       const MapFit& fit);

}  // namespace shadowbench::measure
