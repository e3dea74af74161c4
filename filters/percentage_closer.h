#pragma once

#include <optional>
#include <vector>

#include "filters/kernel.h"
#include "filters/map_reader.h"

namespace shadowbench::filters {

/// The share of a uniform disk that a unit tent beside it gathers, for any offset between the two.
///
/// Tabulated over one quadrant and interpolated bilinearly: for radii up to 64 texels every weight is within 2e-4 of
/// its share of the disk's mean weight.
class DiskWeights {
 public:
  /// Cost: about 0.1 s; it grows with the square of the cells.
  explicit DiskWeights(double radius_texels, double most_cells_per_texel = 96.0);
  double at(double dx, double dy) const;  ///< texel centre less disk centre, texels

 private:
  double reach_;  ///< beyond this the weight is 0
  double cells_per_texel_;
  int side_;
  std::vector<double> table_;
};

/// The brute-force percentage-closer filter: every texel of a kernel compared with one depth, in double precision.
/// Outside the map the depth is what its border says, 1 by default; ties are lit.
/// Source: Reeves, Salesin and Cook 1987, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH.
class PercentageCloser {
 public:
  /// Whose the kernel is.
  enum class Owner {
    kAllReceivers,
    kFewReceivers  ///< others have others: their bias covers one fetch, and a tap farther off has that much more of
                   ///< Receiver::bias_per_texel; a disk's weights are tabulated more coarsely
  };

  /// `map` must outlive this object. With a `plane_max_tangent` every texel is compared with the receiver plane's depth
  /// there; see ModelInput.
  PercentageCloser(const Kernel& kernel, const DepthMap& map, double plane_max_tangent = 0.0,
                   Owner owner = Owner::kAllReceivers);

  /// The weight of the texels that do not block the receiver's biased depth, in [0,1]. Cost: one comparison per texel
  /// of the kernel. Safe to call from many threads.
  double at(const Receiver& receiver) const;

 private:
  /// Weights of consecutive texels of one axis.
  struct Span {
    int first = 0;
    std::vector<double> weights;
  };

  Kernel kernel_;
  TexelGrid<double> grid_;
  const DepthMap& map_;
  PlaneBias plane_;
  double farthest_tap_;              ///< for which more bias is taken off, texels
  std::optional<DiskWeights> disk_;  ///< for disks alone

  /// Give the weights about a position in the memory of a span.
  Span spread(double position, Span span) const;
  Span spread_triangle(double position, Span span) const;

  bool is_lit(int x, int y, const Receiver& receiver) const;
  bool lies_inside(double px, double py) const;

  /// `is_lit` says of a texel whether it blocks no light.
  template <class IsLit>
  double gather(double px, double py, const IsLit& is_lit) const;
  template <class IsLit>
  double gather_grid(double px, double py, const IsLit& is_lit) const;
  template <class IsLit>
  double gather_disk(double px, double py, const IsLit& is_lit) const;
};

}  // namespace shadowbench::filters
