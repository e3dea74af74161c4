#include "filters/percentage_closer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace shadowbench::filters {
namespace {

/// Integrates the unit tent around 0 over [from, to], both cut to [-1,1].
double integrate_tent(double from, double to) {
  const auto below = [](double x) {
    const double t = std::clamp(x, -1.0, 1.0);
    return t < 0.0 ? 0.5 * (1.0 + t) * (1.0 + t) : 1.0 - 0.5 * (1.0 - t) * (1.0 - t);
  };
  return below(to) - below(from);
}

/// Integrates `f` over [a, b] with the Gauss-Legendre rule of 8 points (Abramowitz and Stegun 1964, table 25.4).
template <class Function>
double integrate(double a, double b, Function f) {
  constexpr std::array<double, 4> kNodes = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                            0.9602898564975363};
  constexpr std::array<double, 4> kWeights = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                              0.1012285362903763};
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  double sum = 0.0;
  for (std::size_t i = 0; i < kNodes.size(); ++i)
    sum += kWeights[i] * (f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]));
  return half * sum;
}

/// The tent around (dx, dy), gathered over a disk around 0: chord by chord, in pieces between the tent's kinks.
double gather_tent(double radius, double dx, double dy) {
  const auto chord = [&](double y) {
    const double half = std::sqrt(std::max(radius * radius - y * y, 0.0));
    return (1.0 - std::abs(y - dy)) * integrate_tent(-half - dx, half - dx);
  };
  double sum = 0.0;
  constexpr int kPieces = 4;  // per half of the tent: chords that end near a kink are not smooth
  for (const double from : {dy - 1.0, dy}) {
    const double a = std::max(from, -radius), b = std::min(from + 1.0, radius);
    for (int i = 0; i < kPieces && a < b; ++i)
      sum += integrate(a + (b - a) * i / kPieces, a + (b - a) * (i + 1) / kPieces, chord);
  }
  return sum / (std::numbers::pi * radius * radius);
}

constexpr int kMaxTableSide = 640;
constexpr double kFewCellsPerTexel = 16.0;

}  // namespace

DiskWeights::DiskWeights(double radius_texels, double most_cells_per_texel)
    : reach_(radius_texels + 1.0),
      cells_per_texel_(std::min(most_cells_per_texel, (kMaxTableSide - 2) / reach_)),
      side_(static_cast<int>(std::ceil(reach_ * cells_per_texel_)) + 2),
      table_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {
  const auto side = static_cast<std::size_t>(side_);
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x <= y; ++x) {
      const double weight = gather_tent(radius_texels, static_cast<double>(x) / cells_per_texel_,
                                        static_cast<double>(y) / cells_per_texel_);
      table_[y * side + x] = table_[x * side + y] = weight;
    }
  }
}

double DiskWeights::at(double dx, double dy) const {
  const double x = std::abs(dx), y = std::abs(dy);
  if (x >= reach_ || y >= reach_) return 0.0;
  const double tx = x * cells_per_texel_, ty = y * cells_per_texel_;
  const auto ix = static_cast<std::size_t>(tx), iy = static_cast<std::size_t>(ty),
             side = static_cast<std::size_t>(side_);
  const double sx = tx - static_cast<double>(ix), sy = ty - static_cast<double>(iy);
  const double* row = &table_[iy * side + ix];
  const double low = row[0] + sx * (row[1] - row[0]);
  const double high = row[side] + sx * (row[side + 1] - row[side]);
  return low + sy * (high - low);
}

PercentageCloser::PercentageCloser(const Kernel& kernel, const DepthMap& map, double plane_max_tangent, Owner owner)
    : kernel_(kernel),
      grid_(map.size, map.border),
      map_(map),
      plane_(plane_max_tangent),
      farthest_tap_(owner == Owner::kFewReceivers ? kernel.disk_radius() : 0.0) {
  if (!kernel.atoms().empty() || kernel.triangle() > 0.0) return;
  if (owner == Owner::kAllReceivers)
    disk_.emplace(kernel.disk_radius());
  else
    disk_.emplace(kernel.disk_radius(), kFewCellsPerTexel);
}

bool PercentageCloser::is_lit(int x, int y, const Receiver& receiver) const {
  const glm::dvec2 centre{x + 0.5, y + 0.5};
  float biased = receiver.depth;
  if (farthest_tap_ > 0.0) {
    const glm::dvec2 way = glm::abs(centre - glm::dvec2(receiver.uv) * static_cast<double>(grid_.size()));
    biased -= glm::dot(receiver.bias_per_texel, glm::vec2(glm::min(way, farthest_tap_)));
  }
  const float depth = plane_.depth(receiver, grid_.size(), centre, 0.0, biased);
  return map_.is_lit(depth, map_.at(grid_.find(x, y)));
}

PercentageCloser::Span PercentageCloser::spread_triangle(double position, Span span) const {
  const double h = kernel_.triangle();
  span.first = static_cast<int>(std::floor(position - h));
  span.weights.clear();
  const int last = static_cast<int>(std::floor(position + h));
  for (int texel = span.first; texel <= last; ++texel)
    span.weights.push_back(integrate_tent((texel - position) / h, (texel + 1 - position) / h));
  return span;
}

/// `position` in texels, texel centres at .5.
PercentageCloser::Span PercentageCloser::spread(double position, Span span) const {
  if (kernel_.triangle() > 0.0) return spread_triangle(position, std::move(span));
  const bool bilinear = kernel_.reconstruction() == Reconstruction::kBilinear;
  const double shift = bilinear ? 0.5 : 0.0;
  span.first = static_cast<int>(std::floor(position + kernel_.atoms().front().offset - shift));
  const int last = static_cast<int>(std::floor(position + kernel_.atoms().back().offset - shift)) + 1;
  span.weights.assign(static_cast<std::size_t>(last - span.first + 1), 0.0);
  for (const Kernel::Atom& atom : kernel_.atoms()) {
    const double at = position + atom.offset - shift, base = std::floor(at);
    const auto texel = static_cast<std::size_t>(static_cast<int>(base) - span.first);
    const double fraction = bilinear ? at - base : 0.0;
    span.weights[texel] += atom.weight * (1.0 - fraction);
    span.weights[texel + 1] += atom.weight * fraction;
  }
  return span;
}

template <class IsLit>
double PercentageCloser::gather_grid(double px, double py, const IsLit& is_lit) const {
  thread_local Span columns, rows;
  columns = spread(px, std::move(columns));
  rows = spread(py, std::move(rows));
  double sum = 0.0;
  for (std::size_t y = 0; y < rows.weights.size(); ++y) {
    double row = 0.0;
    for (std::size_t x = 0; x < columns.weights.size(); ++x)
      if (is_lit(columns.first + static_cast<int>(x), rows.first + static_cast<int>(y))) row += columns.weights[x];
    sum += rows.weights[y] * row;
  }
  return sum;
}

/// Most receivers have texels of one kind around them, which need no weights.
template <class IsLit>
double PercentageCloser::gather_disk(double px, double py, const IsLit& is_lit) const {
  const double reach = kernel_.half_width();
  const int left = static_cast<int>(std::floor(px - reach)), right = static_cast<int>(std::ceil(px + reach)),
            bottom = static_cast<int>(std::floor(py - reach)), top = static_cast<int>(std::ceil(py + reach));
  const bool first = is_lit(left, bottom);
  const auto agree = [&] {
    for (int y = bottom; y <= top; ++y)
      for (int x = left; x <= right; ++x)
        if (is_lit(x, y) != first) return false;
    return true;
  };
  if (agree()) return first ? 1.0 : 0.0;
  double lit = 0.0, all = 0.0;
  for (int y = bottom; y <= top; ++y) {
    for (int x = left; x <= right; ++x) {
      const double weight = disk_->at(x + 0.5 - px, y + 0.5 - py);
      all += weight;
      if (is_lit(x, y)) lit += weight;
    }
  }
  return lit / all;
}

template <class IsLit>
double PercentageCloser::gather(double px, double py, const IsLit& is_lit) const {
  return disk_ ? gather_disk(px, py, is_lit) : gather_grid(px, py, is_lit);
}

/// Whether all texels about a position lie in the map.
bool PercentageCloser::lies_inside(double px, double py) const {
  const double reach = kernel_.half_width() + 1.0;
  return std::min(px, py) >= reach && std::max(px, py) + reach + 1.0 <= static_cast<double>(map_.size);
}

double PercentageCloser::at(const Receiver& receiver) const {
  const double px = grid_.position(receiver.uv.x, 0.0), py = grid_.position(receiver.uv.y, 0.0);
  if (plane_.is_on() || farthest_tap_ > 0.0)
    return gather(px, py, [&](int x, int y) { return is_lit(x, y, receiver); });
  const float reference = map_.reference(receiver.depth);
  if (!lies_inside(px, py))
    return gather(
        px, py, [&](int x, int y) { return map_.curve.is_lit(reference, map_.at(grid_.find(x, y))); });
  return gather(px, py, [&, size = static_cast<std::size_t>(map_.size)](int x, int y) {
    return map_.curve.is_lit(reference, map_.stored[static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x)]);
  });
}

}  // namespace shadowbench::filters
