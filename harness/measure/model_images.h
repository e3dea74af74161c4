#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdint>
#include <vector>

#include "filters/catalogue.h"
#include "filters/kernel.h"
#include "filters/model.h"
#include "filters/receiver.h"

namespace shadowbench::measure {

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
};

/// Evaluates a model for receivers that the GPU handed out, in parallel. Requires a filter that has a kernel or a
/// model.
ModelImages evaluate_model(const filters::FilterRequest& request, const std::vector<ModelLayer>& layers,
                           const ModelView& view);

/// The brute-force percentage-closer filter with one kernel for all pixels, in parallel; an image as those of a model.
std::vector<double> compare_kernel(const filters::Kernel& kernel, const std::vector<ModelLayer>& layers,
                                   const ModelView& view);

}  // namespace shadowbench::measure
