#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

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

}  // namespace shadowbench::measure
