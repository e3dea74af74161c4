#include "filters/kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "filters/disk_points.h"

namespace shadowbench::filters {
namespace {

/// Inverts the distribution of the unit tent on [-1,1].
double sample_tent(double u) { return u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 * (1.0 - u)); }

double sample_atoms(const std::vector<Kernel::Atom>& atoms, double u) {
  double sum = 0.0;
  for (const Kernel::Atom& atom : atoms) {
    sum += atom.weight;
    if (u < sum) return atom.offset;
  }
  return atoms.back().offset;
}

/// The half-width of what a reconstruction adds to a shape.
double half_width_of(Reconstruction reconstruction) {
  switch (reconstruction) {
    case Reconstruction::kNearest: return 0.0;
    case Reconstruction::kBilinear: return 1.0;
    case Reconstruction::kTexel: return 0.5;
  }
  return 0.0;
}

}  // namespace

Kernel Kernel::make_point(Reconstruction reconstruction) { return make_grid({{0.0, 1.0}}, reconstruction); }

Kernel Kernel::make_grid(std::vector<Atom> atoms, Reconstruction reconstruction) {
  assert(!atoms.empty());
  Kernel kernel;
  kernel.atoms_ = std::move(atoms);
  kernel.reconstruction_ = reconstruction;
  return kernel;
}

Kernel Kernel::make_box(int taps, Reconstruction reconstruction) {
  std::vector<Atom> atoms;
  for (int i = 0; i < taps; ++i) atoms.push_back({i - 0.5 * (taps - 1), 1.0 / taps});
  return make_grid(std::move(atoms), reconstruction);
}

Kernel Kernel::make_gaussian(int radius_texels, Reconstruction reconstruction) {
  const std::vector<float> weights = gaussian_weights(radius_texels);
  std::vector<Atom> atoms;
  for (int i = -radius_texels; i <= radius_texels; ++i) {
    atoms.push_back(
        {static_cast<double>(i), static_cast<double>(weights[static_cast<std::size_t>(i + radius_texels)])});
  }
  return make_grid(std::move(atoms), reconstruction);
}

Kernel Kernel::make_disk(double radius_texels) {
  if (radius_texels <= 0.0) return make_point(Reconstruction::kBilinear);
  Kernel kernel;
  kernel.disk_radius_ = radius_texels;
  kernel.reconstruction_ = Reconstruction::kBilinear;
  return kernel;
}

Kernel Kernel::make_triangle(double half_width_texels) {
  assert(half_width_texels > 0.0);
  Kernel kernel;
  kernel.triangle_ = half_width_texels;
  kernel.reconstruction_ = Reconstruction::kTexel;
  return kernel;
}

glm::dvec2 Kernel::sample_shape(const glm::dvec2& u) const {
  if (triangle_ > 0.0) return triangle_ * glm::dvec2(sample_tent(u.x), sample_tent(u.y));
  if (atoms_.empty()) return disk_radius_ * map_to_disk(u);
  return {sample_atoms(atoms_, u.x), sample_atoms(atoms_, u.y)};
}

glm::dvec2 Kernel::sample(const glm::dvec2& shape, const glm::dvec2& between) const {
  const glm::dvec2 position = sample_shape(shape);
  if (reconstruction_ == Reconstruction::kNearest) return position;
  if (reconstruction_ == Reconstruction::kTexel) return position + between - 0.5;
  return position + glm::dvec2(sample_tent(between.x), sample_tent(between.y));
}

double Kernel::half_width() const {
  const double grid = atoms_.empty() ? 0.0 : std::max(-atoms_.front().offset, atoms_.back().offset);
  return grid + disk_radius_ + triangle_ + half_width_of(reconstruction_);
}

double Kernel::sigma_texels() const {
  // Variances add under convolution; those of a disk along an axis, of a triangle, of the unit tent and of a texel:
  double variance = 0.25 * disk_radius_ * disk_radius_ + triangle_ * triangle_ / 6.0;
  variance += reconstruction_ == Reconstruction::kBilinear ? 1.0 / 6.0 : 1.0 / 12.0;
  for (const Atom& atom : atoms_) variance += atom.weight * atom.offset * atom.offset;
  return std::sqrt(variance);
}

bool Kernel::is_point() const { return half_width() == 0.0; }

std::string Kernel::name() const {
  if (triangle_ > 0.0) return fmt::format("texel * triangle {}", triangle_);
  std::string text = reconstruction_ == Reconstruction::kBilinear ? "tent" : "point";
  if (atoms_.empty()) return text + fmt::format(" * disk {}", disk_radius_);
  for (const Atom& atom : atoms_) text += fmt::format(" {}:{}", atom.offset, atom.weight);
  return text;
}

std::vector<float> gaussian_weights(int radius_texels) {
  if (radius_texels == 0) return {1.0f};
  std::vector<double> exact;
  double sum = 0.0;
  for (int i = -radius_texels; i <= radius_texels; ++i) {
    const double deviations = 2.0 * i / radius_texels;
    exact.push_back(std::exp(-0.5 * deviations * deviations));
    sum += exact.back();
  }
  std::vector<float> weights;
  for (const double weight : exact) weights.push_back(static_cast<float>(weight / sum));
  return weights;
}

}  // namespace shadowbench::filters
