#pragma once

#include <optional>

#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
#include "harness/scene/shadow_edges.h"
#include "report/images/image.h"
#include "report/records/records.h"

namespace shadowbench::measure {

/// Where the pixels of a view fall in a light's map; rows top to bottom.
struct MapCoverage {
  /// Map texels under each pixel's footprint; 0 on a surface turned away from the light or outside the
  /// map, -1 on the background.
  images::Image density;
  /// Place of each receiver in the map, two channels, in texels from its first row and column; 0 elsewhere.
  images::Image texel;
  std::vector<std::optional<double>> texels_per_pixel;  ///< median of each layer
  records::CoverageRecord record;                       ///< empty fields where no receiver in the map faces the light
};

/// Lays the pixels of a view out in the map.
///
/// A pixel's footprint is the parallelogram that its sides cut out of its receiver's tangent plane, seen from the
/// camera; it follows from camera, position and geometric normal (first order: the plane is the surface), so no
/// neighbour of another surface has a say. Its area along the light, over a texel's area, is the texels per pixel.
/// `map_used` is the share of the map's area under footprints, counted in cells of 1/512 of its side, or in texels
/// where it has fewer; a footprint wider than 64 cells counts where its centre lies. `map_filled` is the share of the
/// texels of `depth_map` that are nearer than 1. Cost: 0.05 s for half a million pixels on one core, and one pass over
/// the map.
/// Of a map with layers a pixel falls in the one that serves most of it; layers stand side by side, as in `depth_map`.
MapCoverage measure_coverage(const ViewReceivers& receivers, const scene::Camera& camera,
                             const std::vector<TracedLayer>& layers, const images::Image& depth_map);

/// Finds the width that a scene's light asks of a kernel, in a view and a map: the standard deviation along an axis, in
/// texels, of the kernel that blurs an edge as the light's penumbra does, of the median of the penumbrae in view. Each
/// counts by its width, as the pixels that lie in it do. Rounded to a hundredth of a texel. Empty where no edge of a
/// shadow is in view. Cost: a picture of one ray for each pixel, 240 pixels wide; no map is drawn.
std::optional<double> find_light_sigma(const scene::EdgeMeter& meter, const options::RunOptions& options,
                                       const MapFit& fit);

}  // namespace shadowbench::measure
