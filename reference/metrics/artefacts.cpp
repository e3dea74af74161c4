#include "reference/metrics/artefacts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/glm.hpp>

namespace shadowbench::metrics {
namespace {

template <class IsFault>
std::optional<double> rate(std::span<const float> image, std::span<const std::uint8_t> mask, IsFault is_fault) {
  assert(image.size() == mask.size());
  double faults = 0.0, count = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!mask[i]) continue;
    count += 1.0;
    if (!std::isfinite(image[i]) || is_fault(image[i])) faults += 1.0;
  }
  if (count < kFewestReceivers) return std::nullopt;
  return faults / count;
}

/// Visits the 3 x 3 pixels about one until `visit` says no. False then, and at the image's edge.
template <class Visit>
bool visit_window(std::size_t i, int width, int height, Visit visit) {
  const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
  if (x == 0 || y == 0 || x + 1 == width || y + 1 == height) return false;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx)
      if (!visit(static_cast<std::size_t>((y + dy) * width + x + dx))) return false;
  }
  return true;
}

}  // namespace

ArtefactMasks make_artefact_masks(const RaysAtReceivers& rays) {
  const std::size_t pixels = rays.counts.size();
  const std::vector<std::uint8_t> none(pixels);
  ArtefactMasks masks{.acne = none, .leak = none, .contact_gap = none};
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!rays.counts[i]) continue;
    const bool settled = rays.area_settled[i] && rays.surroundings_settled[i];
    const bool touches = static_cast<double>(rays.first_blocker_ws[i]) <= rays.contact_ws;
    if (settled && rays.area[i] == 1.0f && rays.surroundings[i] == 1.0f) masks.acne[i] = 1;
    if (settled && rays.area[i] == 0.0f && rays.surroundings[i] == 0.0f && !touches) masks.leak[i] = 1;
    if (rays.area[i] == 0.0f && touches) masks.contact_gap[i] = 1;
  }
  return masks;
}

std::optional<double> rate_below(std::span<const float> image, std::span<const std::uint8_t> mask, double limit) {
  return rate(
      image, mask, [&](float value) { return static_cast<double>(value) < limit; });
}

std::optional<double> rate_above(std::span<const float> image, std::span<const std::uint8_t> mask, double limit) {
  return rate(
      image, mask, [&](float value) { return static_cast<double>(value) > limit; });
}

std::optional<double> rate_contact_gap(std::span<const float> image, std::span<const float> unbiased,
                                       std::span<const std::uint8_t> mask) {
  constexpr double kLimit = kArtefactLimits.contact_gap_above;
  std::vector<float> added(image.size());
  std::vector<std::uint8_t> dark(mask.begin(), mask.end());
  for (std::size_t i = 0; i < image.size(); ++i) {
    added[i] = image[i] - unbiased[i];
    if (!(static_cast<double>(unbiased[i]) <= kLimit)) dark[i] = 0;
  }
  return rate_above(added, dark, kLimit);
}

std::optional<double> rate_noise(std::span<const float> image, std::span<const double> closer,
                                 std::span<const float> kernel, std::span<const std::uint8_t> counts, int width) {
  const int height = static_cast<int>(image.size()) / width;
  double noisy = 0.0, count = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!counts[i] || !(kernel[i] > 0.0f && kernel[i] < 1.0f)) continue;
    double sum = 0.0;
    const bool whole = visit_window(i, width, height, [&](std::size_t n) {
      sum += static_cast<double>(image[n]) - closer[n];
      return counts[n] != 0;
    });
    if (!whole) continue;
    count += 1.0;
    const double deviation = static_cast<double>(image[i]) - closer[i] - sum / 9.0;
    if (!(std::abs(deviation) <= kArtefactLimits.noise_above)) noisy += 1.0;
  }
  if (count < kFewestReceivers) return std::nullopt;
  return noisy / count;
}

std::optional<double> measure_seam(std::span<const float> image, std::span<const float> truth,
                                   std::span<const std::uint8_t> layers, int width) {
  const int height = static_cast<int>(image.size()) / width;
  const auto index = [&](int x, int y) { return static_cast<std::size_t>(y * width + x); };
  /// Visits pairs of neighbours that count: the first pixel, both indices, and whether one lies below the other.
  const auto visit_pairs = [&](auto&& visit) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (const int below : {0, 1}) {
          if (x + 1 - below >= width || y + below >= height) continue;
          const std::size_t a = index(x, y), b = index(x + 1 - below, y + below);
          if (layers[a] != 0 && layers[b] != 0) visit(glm::ivec2(x, y), a, b, below);
        }
  };
  std::vector<std::uint8_t> is_near(image.size());
  visit_pairs([&](const glm::ivec2& at, std::size_t a, std::size_t b, int) {
    if (layers[a] == layers[b]) return;
    for (int y = std::max(0, at.y - kSeamPixels); y <= std::min(height - 1, at.y + kSeamPixels); ++y)
      for (int x = std::max(0, at.x - kSeamPixels); x <= std::min(width - 1, at.x + kSeamPixels); ++x)
        is_near[index(x, y)] = 1;
  });
  struct Changes {
    double squares = 0.0, count = 0.0;
  };
  std::array<Changes, 2> across, beside;  // of pairs side by side, and of pairs below each other
  visit_pairs([&](const glm::ivec2&, std::size_t a, std::size_t b, int below) {
    if (!is_near[a] || !is_near[b]) return;
    const double change = static_cast<double>(image[a]) - static_cast<double>(truth[a]) -
                          (static_cast<double>(image[b]) - static_cast<double>(truth[b]));
    Changes& changes = (layers[a] == layers[b] ? beside : across)[static_cast<std::size_t>(below)];
    changes.squares += change * change;
    changes.count += 1.0;
  });
  const double pairs = across[0].count + across[1].count;
  if (pairs < kFewestReceivers || beside[0].count < kFewestReceivers || beside[1].count < kFewestReceivers)
    return std::nullopt;
  double expected = 0.0;
  for (std::size_t d = 0; d < 2; ++d) expected += across[d].count / pairs * beside[d].squares / beside[d].count;
  return std::sqrt((across[0].squares + across[1].squares) / pairs) - std::sqrt(expected);
}

}  // namespace shadowbench::metrics
