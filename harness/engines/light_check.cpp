#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "harness/engines/alignment.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::engines {
namespace {

using images::Image;

/// Pairs of our light and theirs, where both are above nothing.
struct LightPairs {
  std::vector<std::size_t> pixels;
  std::vector<double> ours, theirs;
};

LightPairs pair_lights(const Image& unlit, const OwnView& own) {
  LightPairs pairs;
  for (std::size_t i = 0; i < unlit.texels.size(); ++i) {
    const float a = own.direct.texels[i], b = unlit.texels[i];
    if (!own.counts[i] || !(a > 0.01f) || !(b > 0.0f) || !std::isfinite(b)) continue;
    pairs.pixels.push_back(i);
    pairs.ours.push_back(static_cast<double>(a));
    pairs.theirs.push_back(static_cast<double>(b));
  }
  return pairs;
}

/// The exponent p of theirs = k ours^p, by least squares on logarithms; nothing where ours hardly varies.
std::optional<double> fit_exponent(const LightPairs& pairs) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < pairs.ours.size(); ++i) {
    const double a = std::log(pairs.ours[i]), b = std::log(pairs.theirs[i]);
    n += 1.0, x += a, y += b, xx += a * a, xy += a * b;
  }
  constexpr double kLeastVariance = 0.01;  // of the logarithm: a tenth up and down
  const double variance = n > 0.0 ? xx / n - x * x / (n * n) : 0.0;
  if (variance < kLeastVariance) return std::nullopt;
  return (xy / n - x * y / (n * n)) / variance;
}

/// Says where unlit is no linear light.
void check_encoding(const LightPairs& pairs, std::vector<Finding>& findings) {
  const auto exponent = fit_exponent(pairs);
  constexpr double kOfDisplay = 0.45, kNear = 0.1;
  if (!exponent || std::abs(*exponent - kOfDisplay) > kNear) return;
  findings.push_back({true, fmt::format("unlit goes as the {:.2f}th power of the light that falls on our surfaces: "
                                        "these are values for a display (sRGB), not linear light; write the linear "
                                        "ones, before they are encoded",
                                        *exponent)});
}

/// Says where their light falls on our surfaces in other proportions than ours.
void check_proportions(const LightPairs& pairs, std::vector<Finding>& findings) {
  double products = 0.0, squares = 0.0, all = 0.0, rest = 0.0;
  for (std::size_t i = 0; i < pairs.ours.size(); ++i) {
    products += pairs.ours[i] * pairs.theirs[i];
    squares += pairs.ours[i] * pairs.ours[i];
  }
  for (std::size_t i = 0; i < pairs.ours.size(); ++i) {
    const double gap = pairs.theirs[i] - products / squares * pairs.ours[i];
    rest += gap * gap;
    all += pairs.theirs[i] * pairs.theirs[i];
  }
  constexpr double kMostResidual = 0.05;
  if (!(rest > kMostResidual * kMostResidual * all)) return;
  findings.push_back({false, fmt::format("its light falls on our surfaces in other proportions, by {}: the light's "
                                         "direction is another one (mirrored, or as the way to the light), or the "
                                         "materials shine, or are not in the colours of the model",
                                         records::format_rate(std::sqrt(rest / all)))});
}

/// Says where the light reaches other surfaces than ours.
void check_faces(const ExternalImages& images, const OwnView& own, std::vector<Finding>& findings) {
  double surfaces = 0.0, apart = 0.0;
  const std::vector<std::uint8_t> inside = find_inside(own, own.is_surface);
  const float least = least_light(*images.unlit);
  for (std::size_t i = 0; i < own.counts.size(); ++i) {
    if (!inside[i]) continue;
    surfaces += 1.0;
    apart += (images.unlit->texels[i] > least) != (own.counts[i] != 0);
  }
  constexpr double kMost = 0.005;
  if (!(apart > kMost * surfaces)) return;
  findings.push_back({false, fmt::format("{} of the surfaces are lit in one of the two pictures alone: the light's "
                                         "direction is another one (mirrored, or as the way to the light)",
                                         records::format_rate(apart / surfaces))});
}

/// The light, direction times strength, from which matt surfaces of our colours come nearest to theirs.
struct DirectionFit {
  glm::dvec3 light{0.0};
  double residual = 1.0;  ///< root mean square, as a share of theirs
};

/// Nothing where the normals have few directions.
std::optional<DirectionFit> fit_direction(const LightPairs& pairs, const OwnView& own) {
  const glm::dvec3 to_light(*own.to_light_ws);
  const auto scale = [&](std::size_t i) {
    const glm::dvec3 normal(own.normals_ws[pairs.pixels[i]]);
    return pairs.ours[i] / glm::dot(normal, to_light) * normal;
  };
  glm::dmat3 products(0.0);
  glm::dvec3 right(0.0);
  for (std::size_t i = 0; i < pairs.pixels.size(); ++i) {
    products += glm::outerProduct(scale(i), scale(i));
    right += pairs.theirs[i] * scale(i);
  }
  const double size = products[0][0] + products[1][1] + products[2][2];
  if (!(glm::determinant(products) > 1e-6 * size * size * size)) return std::nullopt;
  DirectionFit fit{glm::inverse(products) * right};
  double squares = 0.0, all = 0.0;
  for (std::size_t i = 0; i < pairs.pixels.size(); ++i) {
    const double gap = pairs.theirs[i] - glm::dot(scale(i), fit.light);
    squares += gap * gap;
    all += pairs.theirs[i] * pairs.theirs[i];
  }
  fit.residual = std::sqrt(squares / all);
  return fit;
}

/// Finds the direction from which a matt surface of our colours would have their light.
void check_direction(const LightPairs& pairs, const OwnView& own, std::vector<Finding>& findings) {
  if (!own.to_light_ws) return;
  const std::optional<DirectionFit> fit = fit_direction(pairs, own);
  constexpr double kMostResidual = 0.03, kMostDegrees = 0.25;
  if (!fit || fit->residual > kMostResidual) return check_proportions(pairs, findings);
  const double cosine = glm::dot(glm::normalize(fit->light), glm::dvec3(*own.to_light_ws));
  const double degrees = glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
  if (degrees < kMostDegrees) return;
  findings.push_back({false, fmt::format("its surfaces are lit from {:.2g} degrees beside our light: its materials "
                                         "shine, or the light's direction is another one, or its target is not where "
                                         "it shines",
                                         degrees)});
}

/// Whether all values are codes of eight bits; also says so, or that they are half floats.
bool check_steps(const ExternalImages& images, std::vector<Finding>& findings) {
  // Few values may be on a grid by chance, or by the number of a filter's taps.
  const std::size_t fewest = images.unlit ? 3 : 64;
  constexpr std::size_t kFewestOfHalf = 16;
  bool is_coded = true, is_half = true;
  std::set<float> values;
  for (const std::optional<Image>* image : {&images.unlit, &images.lit, &images.visibility}) {
    if (!*image) continue;
    const Image half = images::round_to_half(**image);
    for (std::size_t i = 0; i < half.texels.size(); ++i) {
      const float value = (*image)->texels[i], code = 255.0f * value;
      if (!std::isfinite(value) || value == 0.0f || value == 1.0f) continue;
      is_coded = is_coded && std::abs(code - std::round(code)) < 1e-3f;
      is_half = is_half && value == half.texels[i];
      if (values.size() < fewest + kFewestOfHalf) values.insert(value);
    }
  }
  is_coded = is_coded && values.size() >= fewest;
  if (is_coded)
    findings.push_back({false,
                        "its values are steps of 1/255: eight bits leave visibility uncertain by some hundredths "
                        "in dark places; write floats"});
  else if (is_half && values.size() >= fewest + kFewestOfHalf)
    findings.push_back({false, "its values are half floats: visibility is uncertain by up to 0.0005"});
  return is_coded;
}

void check_samples(const LightPairs& pairs, const OwnView& own, std::vector<Finding>& findings) {
  if (pairs.pixels.empty()) return;
  const std::vector<std::uint8_t> inside = find_inside(own, own.counts);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < pairs.pixels.size(); ++i) ratios.push_back(pairs.theirs[i] / pairs.ours[i]);
  std::vector<double> sorted = ratios;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  std::array<double, 2> odd{}, all{};
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const std::size_t where = inside[pairs.pixels[i]];
    all[where] += 1.0;
    odd[where] += std::abs(ratios[i] / usual - 1.0) > 0.1;
  }
  if (all[0] == 0.0 || all[1] == 0.0 || odd[1] > 0.005 * all[1] || odd[0] < 0.05 * all[0]) return;
  findings.push_back(
      {false, fmt::format("{} of the pixels at silhouettes have other light than our surfaces there, and "
                          "hardly any inside: it is antialiased; switch multisampling off, or look at "
                          "the error without silhouettes",
                          records::format_rate(odd[0] / all[0]))});
}

}  // namespace

float least_light(const Image& unlit) {
  constexpr float kNoise = 1e-6f;
  float most = 0.0f;
  for (const float value : unlit.texels)
    if (std::isfinite(value)) most = std::max(most, value);
  return kNoise * most;
}

void check_light(const ExternalImages& images, const OwnView& own, std::vector<Finding>& findings) {
  const bool is_coded = check_steps(images, findings);
  if (!images.unlit) return;
  const LightPairs pairs = pair_lights(*images.unlit, own);
  check_encoding(pairs, findings);
  if (!is_coded) check_direction(pairs, own, findings);  // steps look like another direction
  check_faces(images, own, findings);
  check_samples(pairs, own, findings);
}

}  // namespace shadowbench::engines
