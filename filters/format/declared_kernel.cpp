#include "filters/format/declared_kernel.h"

namespace shadowbench::filters {
namespace {

Kernel make_taps(const std::vector<double>& weights, Reconstruction reconstruction) {
  const double middle = 0.5 * (static_cast<double>(weights.size()) - 1.0);
  std::vector<Kernel::Atom> atoms;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0.0) atoms.push_back({static_cast<double>(i) - middle, weights[i]});
  return Kernel::make_grid(std::move(atoms), reconstruction);
}

}  // namespace

Kernel make_kernel(const DeclaredKernel& declared, const ParamValues& values) {
  const Reconstruction read = declared.reads_nearest ? Reconstruction::kNearest : Reconstruction::kBilinear;
  if (declared.shape == KernelShape::kWeights) return make_taps(declared.weights, read);
  const double size = number_or_param(declared.size, values);
  switch (declared.shape) {
    case KernelShape::kTent: return Kernel::make_triangle(size);
    case KernelShape::kDisk: return Kernel::make_disk(size);
    case KernelShape::kGaussian: return Kernel::make_gaussian(static_cast<int>(size), read);
    default: return Kernel::make_box(static_cast<int>(size), read);
  }
}

}  // namespace shadowbench::filters
